// Holds Kubernetes manifests to the API of 1.32 without a cluster:
//
//   node validate_manifests.mjs NODE_MODULES MANIFESTS.yaml
//
// Two independent descriptions of that API are asked: the JSON schemas of kubernetes-models
// for types and required fields, the models of @kubernetes/client-node for names that no
// such object has. Those models lack custom kinds: there it is a field that the schema's
// check never reads. Prints every fault with its place; exit code 1 when there is one.
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {join} from 'node:path';
import {pathToFileURL} from 'node:url';

const [nodeModules, manifests] = process.argv.slice(2);
const require = createRequire(join(nodeModules, 'any.js'));
const models = await import(pathToFileURL(join(nodeModules, '@kubernetes/client-node/dist/gen/models/all.js')));
const yaml = require('js-yaml');

// Kinds that Kubernetes itself does not know: their schemas come from elsewhere.
const customKinds = {'monitoring.coreos.com/v1': '@kubernetes-models/prometheus-operator/monitoring.coreos.com/v1'};

// What is wrong with types and required fields of an object of `apiVersion` and `kind`.
function schemaFaults(object, {apiVersion, kind} = object) {
  const module = customKinds[apiVersion] ?? join('kubernetes-models', apiVersion);
  try {
    require(module)[kind].prototype.validate.call(object);
    return [];
  } catch (error) {
    return [error.message];
  }
}

// `value`, but who reads a field of it takes the field's place out of `unread`.
function watched(value, place, unread) {
  if (value === null || typeof value !== 'object') return value;
  const copy = Array.isArray(value) ? [] : {};
  for (const [name, each] of Object.entries(value)) {
    const field = `${place}.${name}`;
    const inner = watched(each, field, unread);
    unread.add(field);
    Object.defineProperty(copy, name, {enumerable: true, get: () => (unread.delete(field), inner)});
  }
  return copy;
}

// The fields of an object of a custom kind that its schema does not have.
function unreadFields(object, place) {
  const unread = new Set();
  schemaFaults(watched(object, place, unread), object);
  return [...unread].map((field) => `${field}: ${object.kind} has no such field`);
}

// client-node's name of a kind: V1Deployment, V2HorizontalPodAutoscaler.
function modelName(object) {
  const version = object.apiVersion.split('/').at(-1);
  return version[0].toUpperCase() + version.slice(1) + object.kind;
}

// The fields of `value`, a `type` in client-node's words, that the type does not have.
function unknownFields(value, type, place) {
  const element = type.match(/^Array<(.*)>$/)?.[1] ?? type.match(/^\{ \[key: string\]: (.*); \}$/)?.[1];
  if (element !== undefined) {
    return Object.entries(value ?? {}).flatMap(([key, each]) => unknownFields(each, element, `${place}.${key}`));
  }
  const model = models[type];
  if (model?.getAttributeTypeMap === undefined || value === null || typeof value !== 'object') return [];
  const fields = new Map(model.getAttributeTypeMap().map((field) => [field.baseName, field.type]));
  return Object.entries(value).flatMap(([name, each]) => fields.has(name)
    ? unknownFields(each, fields.get(name), `${place}.${name}`)
    : [`${place}.${name}: ${type} has no such field`]);
}

const objects = yaml.loadAll(readFileSync(manifests, 'utf8')).filter((object) => object);
let faults = objects.length > 0 ? [] : ['no object at all'];
for (const object of objects) {
  const place = `${object.kind} ${object.metadata?.name}`;
  faults.push(...schemaFaults(object).map((fault) => `${place}: ${fault}`));
  if (object.apiVersion in customKinds) {
    faults.push(...unreadFields(object, place));
  } else {
    const type = modelName(object);
    if (models[type] === undefined) faults.push(`${place}: ${object.apiVersion} has no such kind`);
    else faults.push(...unknownFields(object, type, place));
  }
}
faults.forEach((fault) => console.error(fault));
if (faults.length === 0) console.log(`${objects.length} objects hold: ${objects.map((object) => object.kind).join(', ')}`);
process.exit(faults.length > 0 ? 1 : 0);

// gRPC's client for Node.js against a server: client.js ADDRESS PROTO_FOLDER, with
// NODE_PATH set. Reads {request, bad} from standard input; prints what came as JSON: the
// hash of the first tile's heights, and the code and details of the bad request.
'use strict';

const fs = require('fs');
const grpc = require('@grpc/grpc-js');
const loader = require('@grpc/proto-loader');

const [address, protoFolder] = process.argv.slice(2);
const definition = loader.loadSync('terrane/v1/terrain.proto', { includeDirs: [protoFolder], longs: String });
const { TerrainService } = grpc.loadPackageDefinition(definition).terrane.v1;
const client = new TerrainService(address, grpc.credentials.createInsecure());

// FNV-1a, 64 bits, as the golden files have it.
function fnv1a(bytes) {
  let hash = 0xcbf29ce484222325n;
  for (const byte of bytes) {
    hash = ((hash ^ BigInt(byte)) * 0x100000001b3n) & 0xffffffffffffffffn;
  }
  return hash.toString(16).padStart(16, '0');
}

// Every message of a stream and its status, the deadline being far away.
function stream(request) {
  return new Promise((resolve) => {
    const messages = [];
    const call = client.streamTiles(request, { deadline: Date.now() + 100000 });
    call.on('data', (message) => messages.push(message));
    call.on('error', () => {}); // comes as status as well
    call.on('status', (status) => resolve({ messages, status }));
  });
}

async function main() {
  const { request, bad } = JSON.parse(fs.readFileSync(0, 'utf8'));
  const good = await stream(request);
  const refused = await stream(bad);
  console.log(JSON.stringify({
    code: good.status.code,
    messages: good.messages.length,
    hash: fnv1a(good.messages[1].tile.data),
    badCode: refused.status.code,
    badDetails: refused.status.details,
  }));
  client.close();
}

main();

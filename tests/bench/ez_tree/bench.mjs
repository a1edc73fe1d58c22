// Sections and vertices a second of ez-tree, for compare_ez_tree.sh: node
// bench.mjs SECONDS. Prints a JSON line a preset, and one of all together.
//
// ez-tree makes a tree and its mesh in one pass on one thread, as it does in a
// browser; what it counts as a section is one of Terrane's segments. Its
// textures are images of a page that is not there: they stay empty.
const element = {addEventListener() {}, removeEventListener() {}, style: {}};
globalThis.document = {createElementNS: () => ({...element}), createElement: () => ({...element})};

const {Tree} = await import('@dgreenheck/ez-tree');

const presets = ['Ash Medium', 'Aspen Medium', 'Oak Medium', 'Oak Large', 'Pine Medium', 'Pine Large'];
const seconds = Number(process.argv[2]);

let sections = 0;
const generateBranch = Tree.prototype.generateBranch;
Tree.prototype.generateBranch = function(branch) {
  sections += branch.sectionCount;
  return generateBranch.call(this, branch);
};

function measure(name) {
  const tree = new Tree();
  tree.loadPreset(name); // and the compiler warms up
  tree.options.leaves.count = 0; // wood against wood
  sections = 0;
  let vertices = 0;
  let trees = 0;
  const start = process.cpuUsage();
  let spent = 0;
  while (spent < seconds) {
    tree.options.seed = ++trees;
    tree.generate();
    vertices += tree.branches.verts.length / 3;
    const {user, system} = process.cpuUsage(start);
    spent = (user + system) / 1e6;
  }
  return {name, trees, sections, vertices, seconds: spent};
}

const all = {name: 'all', trees: 0, sections: 0, vertices: 0, seconds: 0};
for (const preset of presets) {
  const run = measure(preset);
  for (const field of ['trees', 'sections', 'vertices', 'seconds']) all[field] += run[field];
  console.log(JSON.stringify(run));
}
console.log(JSON.stringify(all));

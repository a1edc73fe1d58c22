// Validates GLB files with Khronos' gltf-validator: node validate_gltf.js FILE...
// Exits 1 when one has an error or a warning, or cannot be read.
'use strict';

const fs = require('fs');
const path = require('path');
const validator = require('gltf-validator');

async function main() {
  let bad = process.argv.length < 3;
  for (const file of process.argv.slice(2)) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
    const {numErrors, numWarnings, messages} = report.issues;
    console.log(`${path.basename(file)}: ${report.info.totalTriangleCount} triangles, ` +
        `${numErrors} errors, ${numWarnings} warnings`);
    if (numErrors + numWarnings > 0) {
      console.log(messages);
      bad = true;
    }
  }
  process.exit(bad ? 1 : 0);
}

main();

#!/usr/bin/env node
// The program as WebAssembly: arguments, files and exit status are those of the command line.
const oldest = 18;
if (Number(process.versions.node.split('.')[0]) < oldest) {
  console.error(`posewright: node ${process.versions.node} is too old: ${oldest} or later is needed`);
  process.exit(1);
}
await import('./posewright.cjs');

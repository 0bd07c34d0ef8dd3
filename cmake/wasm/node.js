// A trap is one sentence, as other errors are: node would print the addresses of functions.
process.on('uncaughtException', (error) => {
  if (!(error instanceof WebAssembly.RuntimeError || error instanceof RangeError)) return;
  const memory = /memory|allocation|out of bounds/i.test(error.message);
  require('fs').writeSync(2, memory
    ? 'posewright: not enough memory (WebAssembly has 4 GB at most); ask for fewer candidates\n'
    : `posewright: internal error: ${error.message}\n`);
  process.exit(1);
});
// The program has the environment of node; emscripten gives it none, and takes the three standard streams for terminals.
Module['preRun'] = () => {
  Object.assign(ENV, process.env);
};
Module['onRuntimeInitialized'] = () => {
  for (const stream of [0, 1, 2]) FS.getStream(stream).tty = require('tty').isatty(stream);
};

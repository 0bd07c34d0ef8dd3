// The program has the environment of node; emscripten gives it none, and takes the three standard streams for terminals.
Module['preRun'] = () => {
  Object.assign(ENV, process.env);
};
Module['onRuntimeInitialized'] = () => {
  for (const stream of [0, 1, 2]) FS.getStream(stream).tty = require('tty').isatty(stream);
};

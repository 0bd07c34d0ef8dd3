// A page is no terminal: no colours, no questions, and with --verbose a line for each step. emscripten's own streams are terminals;
// these hand each line to print and printErr.
{
  const lines = (say) => {
    const bytes = [];
    const take = (byte) => {
      if (byte !== 10) return void bytes.push(byte & 255);
      say(new TextDecoder().decode(new Uint8Array(bytes)));
      bytes.length = 0;
    };
    take.buffer = bytes;  // closing a stream writes what has no end of line
    return take;
  };
  Module['stdin'] ??= () => null;
  Module['stdout'] ??= lines((line) => (Module['print'] ?? console.log)(line));
  Module['stderr'] ??= lines((line) => (Module['printErr'] ?? console.error)(line));
}

// A problem file in an editor: yaml-language-server, spoken to as an editor does (Language Server Protocol, stdio), with
// the modeline that `init` writes and nothing else to say which schema holds. Exit 77: the server is not installed.
//   node language_server.mjs PROGRAM SOURCE

import {spawn, spawnSync} from "node:child_process";
import assert from "node:assert/strict";
import fs from "node:fs";
import os from "node:os";
import path from "node:path";
import {pathToFileURL} from "node:url";

const [program, source] = process.argv.slice(2);
const server = path.join(source, "report/node_modules/yaml-language-server/bin/yaml-language-server");
if (!fs.existsSync(server)) {
  console.log("Skipped: yaml-language-server is missing (npm ci in report/ installs it).");
  process.exit(77);
}

/** One server: requests with their answers, and diagnostics by file as they come. */
class Client {
  constructor() {
    this.process = spawn(process.execPath, [server, "--stdio"], {stdio: ["pipe", "pipe", "inherit"]});
    this.buffer = Buffer.alloc(0);
    this.waiting = new Map();
    this.diagnosed = new Map();
    this.id = 0;
    this.process.stdout.on("data", (bytes) => this.read(bytes));
  }
  read(bytes) {
    this.buffer = Buffer.concat([this.buffer, bytes]);
    for (;;) {
      const head = this.buffer.indexOf("\r\n\r\n");
      if (head < 0) return;
      const length = Number(/Content-Length: (\d+)/i.exec(this.buffer.subarray(0, head).toString())[1]);
      if (this.buffer.length < head + 4 + length) return;
      const message = JSON.parse(this.buffer.subarray(head + 4, head + 4 + length).toString());
      this.buffer = this.buffer.subarray(head + 4 + length);
      this.take(message);
    }
  }
  take(message) {
    if (message.method === "textDocument/publishDiagnostics") {
      const tell = this.diagnosed.get(message.params.uri);
      if (tell) tell(message.params.diagnostics);
    } else if (message.method !== undefined && message.id !== undefined) {
      // What an editor without settings of its own answers.
      const result = message.method === "workspace/configuration" ? message.params.items.map(() => null) : null;
      this.send({id: message.id, result});
    } else if (message.id !== undefined) {
      const {resolve, reject} = this.waiting.get(message.id);
      if (message.error) reject(new Error(message.error.message));
      else resolve(message.result);
    }
  }
  send(message) {
    const text = JSON.stringify({jsonrpc: "2.0", ...message});
    this.process.stdin.write(`Content-Length: ${Buffer.byteLength(text)}\r\n\r\n${text}`);
  }
  request(method, params) {
    const id = ++this.id;
    this.send({id, method, params});
    return new Promise((resolve, reject) => this.waiting.set(id, {resolve, reject}));
  }
  /** Opens a text as a file; the first diagnostics of it. */
  open(file, text) {
    const uri = pathToFileURL(file).href;
    const found = new Promise((resolve) => this.diagnosed.set(uri, resolve));
    this.send({method: "textDocument/didOpen", params: {textDocument: {uri, languageId: "yaml", version: 1, text}}});
    return found;
  }
  async completion(file, text, mark) {
    const line = text.slice(0, text.indexOf(mark) + mark.length).split("\n");
    const position = {line: line.length - 1, character: line.at(-1).length};
    const answer = await this.request("textDocument/completion",
                                      {textDocument: {uri: pathToFileURL(file).href}, position});
    return new Map((answer.items ?? answer).map((item) => [item.label, item]));
  }
}

const folder = fs.mkdtempSync(path.join(os.tmpdir(), "posewright-editor-"));
const client = new Client();
const alarm = setTimeout(() => { client.process.kill(); throw new Error("the server says nothing"); }, 60000);
try {
  const robot = path.join(source, "examples/kr270/kr270.urdf");
  for (const [name, words] of [["tracker", ["--tracker"]], ["camera", ["--camera", "realsense-d435"]]])
    assert.equal(spawnSync(program, ["init", robot, ...words, "--yes", "-o", path.join(folder, `${name}.yaml`)]).status, 0);

  await client.request("initialize", {processId: process.pid, rootUri: null, capabilities: {
    textDocument: {completion: {completionItem: {documentationFormat: ["plaintext"]}}, publishDiagnostics: {}}}});
  client.send({method: "initialized", params: {}});
  client.send({method: "workspace/didChangeConfiguration", params: {settings: {yaml: {
    validate: true, completion: true, hover: true, schemaStore: {enable: false}}}}});

  for (const name of ["tracker", "camera"]) {
    const file = path.join(folder, `${name}.yaml`);
    assert.deepEqual(await client.open(file, fs.readFileSync(file, "utf8")), [], `what init writes is right: ${name}`);
  }

  const written = fs.readFileSync(path.join(folder, "tracker.yaml"), "utf8");
  const misspelt = written.replace("\nmeasurement:\n  type:", "\nmeasurement:\n  tpye:");
  const diagnostics = await client.open(path.join(folder, "misspelt.yaml"), misspelt);
  const line = misspelt.split("\n").findIndex((text) => text.startsWith("  tpye:"));
  assert.ok(diagnostics.some((d) => d.range.start.line === line || /"type"|tpye/.test(d.message)),
            `a misspelt key is told where it stands: ${JSON.stringify(diagnostics)}`);
  const unknown = written + "  candidate: 5\n";
  const told = await client.open(path.join(folder, "unknown.yaml"), unknown);
  assert.ok(told.some((d) => /candidate/.test(d.message) && d.range.start.line === unknown.split("\n").length - 2),
            JSON.stringify(told));

  for (const [begin, mark, wanted] of [
    ["design:\n  poses: 30\n  cand", "  cand", ["candidates", "candidates_from"]],
    ["robot:\n  urdf: a.urdf\n  enc", "  enc", ["encoder_noise"]],
    ["workspace:\n  joints:\n    mar", "    mar", ["margin", "margin_length"]],
  ]) {
    const text = `${written.split("\n")[0]}\nposewright: 1\n${begin}\n`;
    const file = path.join(folder, `${wanted[0]}.yaml`);
    await client.open(file, text);
    const labels = await client.completion(file, text, mark);
    for (const key of wanted) {
      assert.ok(labels.has(key), `${key} is offered after "${mark}": ${[...labels.keys()]}`);
      assert.ok(labels.get(key).documentation, `${key} is explained`);
    }
  }
  console.log("completion, explanations and diagnostics as an editor gets them");
} finally {
  clearTimeout(alarm);
  client.process.kill();
  fs.rmSync(folder, {recursive: true});
}

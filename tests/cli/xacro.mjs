// node tests/cli/xacro.mjs FILE [NAME:=VALUE…]: expands a xacro file to stdout as the program xacro of ROS does, which no Debian
// package has, by npm's xacro-parser.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const require = createRequire(join(dirname(fileURLToPath(import.meta.url)), '../../report/package.json'));
const { DOMParser, XMLSerializer } = require('@xmldom/xmldom');
globalThis.DOMParser = DOMParser;
globalThis.XMLSerializer = XMLSerializer;
const { XacroParser } = require('xacro-parser');

const [file, ...words] = process.argv.slice(2);
const parser = new XacroParser();
parser.workingPath = `${dirname(file)}/`;
parser.getFileContents = (path) => Promise.resolve(readFileSync(path, 'utf8'));
parser.arguments = Object.fromEntries(words.map((word) => word.split(':=')));
const document = await parser.parse(readFileSync(file, 'utf8'));
process.stdout.write(new XMLSerializer().serializeToString(document));

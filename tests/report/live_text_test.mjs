// node tests/report/live_text_test.mjs
// Edits of the page that plans: the problem's text keeps all but the value that changed. Returns 77 without npm's packages.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';

if (!existsSync(new URL('../../report/node_modules/yaml', import.meta.url))) {
  console.log('Skipped: npm packages are missing (npm ci in report/ installs them).');
  process.exit(77);
}
const { metres, withEntry, withoutEntry, withValue, written } = await import('../../report/src/live/yaml_edit.js');
const { added, moved, removed, resized, thingsOf } = await import('../../report/src/live/things.js');
const { messagesOf, progressOf } = await import('../../report/src/live/messages.js');
const { placeMeshes, planAmong, problemsAmong, robotAmong } = await import('../../report/src/live/robot_files.js');

const cell = readFileSync(new URL('../../examples/cell/problem.yaml', import.meta.url), 'utf8');
const thing = (text, label) => thingsOf(text).find((t) => t.label === label);
/** Lines of b that are not in a. */
const changed = (a, b) => b.split('\n').filter((line, k) => line !== a.split('\n')[k]);

// A body moves: one line changes, and in it the value alone.
const further = moved(cell, thing(cell, 'fixture'), [2.5, 0.2, -0.4]);
assert.deepEqual(changed(cell, further), ['      - {name: fixture, box: [0.9, 1.4, 0.7], at: [2.5, "200 mm", "-400 mm"]}']);
assert.deepEqual(thing(further, 'fixture').position, [2.5, 0.2, -0.4]);
assert.deepEqual(changed(cell, resized(cell, thing(cell, 'fixture'), [1, 1, 0.5])), ['      - {name: fixture, box: [1, 1, "500 mm"], at: [1.9, 0.2, -0.4]}']);

// The tracker takes its own body with it.
const tracker = moved(cell, thing(cell, 'Tracker or station A'), [3.6, 0.6, 0.5]);
assert.deepEqual(thing(tracker, 'tracker').position, [3.6, 0.6, -0.1]);
assert.equal(changed(cell, tracker).length, 2);

// A body comes and goes; comments stay.
const more = added(cell, 'box', [1, 0, 0.3]);
assert.equal(removed(more, thing(more, 'box')), cell);
assert.ok(more.includes('      - {name: box, box: ["600 mm", "600 mm", "600 mm"], at: [1, 0, "300 mm"]}\n  line_of_sight:'));
assert.equal(thing(added(more, 'box', [0, 0, 0]), 'box_2').label, 'box_2');

// Keys that are not there yet.
assert.equal(withValue('a: 1\n', ['design', 'poses'], 20), 'a: 1\ndesign: {poses: 20}\n');
assert.equal(withValue('design: {criterion: o1}   # why\n', ['design', 'poses'], 20), 'design: {criterion: o1, poses: 20}   # why\n');
assert.equal(withValue('design:\n  criterion: o1   # why\nx: 1\n', ['design', 'poses'], 20), 'design:\n  criterion: o1   # why\n  poses: 20\nx: 1\n');
assert.equal(withEntry('a: [1]\n', ['a'], 2), 'a: [1, 2]\n');
assert.equal(withoutEntry('a:\n  - 1\n  - 2\nb: 3\n', ['a', 1]), 'a:\n  - 1\nb: 3\n');
assert.equal(withoutEntry('a:\n  - 1\nb: 3\n', ['a', 0]), 'a:\n  []\nb: 3\n');
assert.equal(withValue('a: [\n', ['a'], 2), 'a: [\n', 'no YAML: nothing changes');

for (const value of [0, 0.0123, -0.75, 1.25, 2]) assert.ok(Math.abs(metres(written(value)) - value) < 1e-9);
assert.ok(Number.isNaN(metres('3 furlongs')));

// What the program says.
const [fault, note] = messagesOf(['candidates 10/100', 'posewright: problem.yaml:23: no; allowed: yes', '  23 |   device', '     |   ^~', 'posewright: note: slow'], 'a/problem.yaml');
assert.deepEqual(fault, { text: 'no; allowed: yes', line: 23, kind: 'error' });
assert.deepEqual(note, { text: 'slow', line: 0, kind: 'note' });
assert.equal(progressOf('candidates 10/100').share, 0.1);
assert.equal(messagesOf(['posewright: robot.urdf:3: no'], 'problem.yaml')[0].line, 0);
assert.equal(messagesOf(['posewright: my cell.yaml:4: no'], 'a/my cell.yaml')[0].line, 4);

// Loose meshes go where the URDF names them.
const bytes = (text) => new TextEncoder().encode(text);
const files = new Map([['r.urdf', bytes('<robot name="r"><mesh filename="package://p/m/a.stl"/><mesh filename="b.stl"/><visual><mesh filename="b.stl"/></visual><visual name="x"><mesh filename="c.dae"/></visual></robot>')], ['a.stl', bytes('solid')]]);
assert.equal(robotAmong(files), 'r.urdf');
assert.deepEqual(placeMeshes(files, 'r.urdf'), { missing: ['b.stl'], looks: ['c.dae'] });
assert.ok(files.has('p/m/a.stl'));

// Problems and plans are known by what is in them; of several problems that of the usual name comes first.
const dropped = new Map([['x/joint_limits.yaml', bytes('joint_limits: {}\n')], ['x/cell.yml', bytes('# mine\nposewright: 1\n')], ['x/calibrated.yaml', bytes('posewright_parameters: 1\n')], ['x/problem.yaml', bytes('posewrigt: 1\n')]]);
assert.deepEqual(problemsAmong(dropped), ['x/problem.yaml', 'x/cell.yml']);
assert.equal(planAmong(new Map([['a.json', bytes('{}')], ['left.json', bytes('{\n "schema": "posewright/plan/1",\n')]])), 'left.json');
assert.equal(planAmong(files), undefined);

// Of several instruments those that stand still are moved, each in its own entry of the list.
const both = readFileSync(new URL('../../examples/instruments/tracker_and_camera.yaml', import.meta.url), 'utf8');
assert.deepEqual(changed(both, moved(both, thing(both, 'tracker, station T'), [4.5, 0, 1])), ['      stations: {T: [4.5, 0, 1]}']);
assert.equal(changed(both, moved(both, thing(both, 'camera, Board'), [2, 0, 1])).length, 1);
const hands = readFileSync(new URL('../../examples/humanoid/both_hands.yaml', import.meta.url), 'utf8');
assert.deepEqual(thingsOf(hands).filter((t) => t.step === 'instrument').map((t) => t.label), ['tracker, station T']);
console.log('Edits keep the text, messages have their lines.');

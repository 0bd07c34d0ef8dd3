// Results of every command that has a page, made by the program itself, small.
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = fileURLToPath(new URL('../../', import.meta.url));
const kr270 = join(root, 'examples/kr270/problem.yaml');
const telescope = join(root, 'examples/telescope/problem.yaml');

/** @typedef {{name: string, page: string, data: any, files: Object<string, string>}} ResultCase data: what the page holds */

/** The tracker that is moved once, with places to choose among. @param {string} folder */
function withPlaces(folder) {
  const text = readFileSync(join(root, 'examples/instruments/tracker_two_stations.yaml'), 'utf8')
    .replace('../kr270/kr270.urdf', join(root, 'examples/kr270/kr270.urdf'))
    .replace(', "station.B.*"', '')
    .replace(
      /variants:/,
      'workspace:\n  stations: {box: {x: [2.5, 4], y: [-2, 2], z: 1, points: [2, 2, 1]}}\n  collision: {obstacles: [{name: table, box: [0.8, 0.5, 0.6], at: [1.5, 1, -0.5]}]}\nvariants:',
    );
  const file = join(folder, 'problem.yaml');
  writeFileSync(file, text);
  return file;
}

/** A cell whose tracker stands in the pillar. @param {string} folder */
function brokenCell(folder) {
  const text = readFileSync(join(root, 'examples/cell/problem.yaml'), 'utf8')
    .replace('../kr270/kr270.urdf', join(root, 'examples/kr270/kr270.urdf'))
    .replace('A: [3.6, -1.4, 0.5]', 'A: [-0.6, -1.7, 0.5]');
  const file = join(folder, 'broken.yaml');
  writeFileSync(file, text);
  return file;
}

/** @param {string} program @param {string} out folder @returns {ResultCase[]} */
export function makeResults(program, out) {
  const run = (...words) => execFileSync(resolve(program), words, { cwd: folder, encoding: 'utf8', maxBuffer: 1e9 });
  const folder = resolve(out, 'results');
  mkdirSync(folder, { recursive: true });
  const save = (name, ...words) => writeFileSync(join(folder, `${name}.json`), run(...words, '--json', '--quiet'));
  const quick = ['--candidates', '200', '--restarts', '1', '--method', 'exchange', '--quiet', '--force'];
  run('plan', kr270, '--poses', '16', ...quick, '-o', 'a.json', '--poses-csv', 'a.csv');
  run('plan', kr270, '--poses', '12', ...quick, '-o', 'b.json', '--poses-csv', 'b.csv');
  save('simulation', 'simulate', kr270, 'a.json', '--draws', '150', '--data', 'measured.csv', '--force');
  save('calibration', 'calibrate', kr270, 'measured.csv', '--hold-back', '4');
  save('calibrations', 'calibrate', kr270, 'measured.csv', '--variant', 'geometric,automatic', '--hold-back', '4');
  save('comparison', 'compare', telescope, '--variant', 'rigid,matrix', '--truth', 'matrix', '--restarts', '1', '--candidates', '150');
  run('plan', telescope, '--variant', 'rigid', '--poses', '30', ...quick, '-o', 't.json', '--poses-csv', 't.csv');
  run('simulate', telescope, 't.json', '--variant', 'rigid', '--draws', '2', '--data', 'legs.csv', '--force', '--quiet');
  save('legs', 'calibrate', telescope, 'legs.csv', '--variant', 'rigid_6,linear,matrix', '--no-prior');
  save('stations', 'stations', withPlaces(folder), '--poses', '16', '--candidates', '150', '--restarts', '1', '--full', '2');
  writeFileSync(join(folder, 'next.json'), readFileSync(new URL('next.json', import.meta.url)));
  const made = ['calibration', 'calibrations', 'legs', 'simulation', 'comparison', 'stations', 'next'].map((name) => ({
    name,
    words: [`${name}.json`],
  }));
  const others = [
    { name: 'two_plans', words: ['a.json', 'b.json'] },
    { name: 'problem', words: [brokenCell(folder)] },
  ];
  return [...made, ...others].map(({ name, words }) => {
    const page = join(folder, `${name}.html`);
    const data = JSON.parse(run('report', ...words, '-o', page, '--force', '--quiet', '--json'));
    return { name, page, data, files: { folder } };
  });
}

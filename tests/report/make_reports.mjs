// Plans, routes and reports of the examples, made by the program itself.
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = fileURLToPath(new URL('../../', import.meta.url));

/** @typedef {{name: string, problem: string, folder: string, page: string, plan: any, data: any, route: boolean}} Case */

/** KR 270 with test poses, which the example has none of. @param {string} folder */
function withTestPoses(folder) {
  const text = readFileSync(join(root, 'examples/kr270/problem.yaml'), 'utf8')
    .replace('urdf: kr270.urdf', `urdf: ${join(root, 'examples/kr270/kr270.urdf')}`)
    .replace(/design:\n/, 'design:\n  test_poses: {random: 12}\n');
  const file = join(folder, 'problem.yaml');
  writeFileSync(file, text);
  return file;
}

const cases = [
  { name: 'telescope', problem: () => 'examples/telescope/problem.yaml', poses: 16 },
  { name: 'kr270', problem: () => 'examples/kr270/problem.yaml', poses: 12 },
  { name: 'test_poses', problem: withTestPoses, poses: 8 },
  { name: 'camera', problem: () => 'examples/instruments/camera_on_hand.yaml', poses: 10 },
  { name: 'robust', problem: () => 'examples/instruments/camera_on_hand.yaml', poses: 12, robust: 20 },
  { name: 'instruments', problem: () => 'examples/instruments/tracker_and_camera.yaml', poses: 14 },
  { name: 'cell', problem: () => 'examples/cell/problem.yaml', poses: 8, candidates: 80, route: true },
];

/**
 * @param {string} program @param {string} out folder @param {{poses?: number, candidates: number}} [size] whole plans where given
 * @returns {Case[]}
 */
export function makeReports(program, out, names = cases.map((c) => c.name), full = false) {
  const run = (...words) => execFileSync(resolve(program), words, { cwd: root, encoding: 'utf8', maxBuffer: 1e9 });
  return cases
    .filter((c) => names.includes(c.name))
    .map((c) => {
      const folder = resolve(out, c.name);
      mkdirSync(folder, { recursive: true });
      const problem = c.problem(folder);
      const [plan, route, page] = ['plan.json', 'route.json', 'report.html'].map((name) => join(folder, name));
      const size = full
        ? ['--candidates', '3000']
        : ['--poses', String(c.poses), '--candidates', String(c.candidates ?? 100), '--restarts', '1', '--method', 'exchange'];
      const robust = c.robust ? ['--robust', String(c.robust)] : [];
      run('plan', problem, ...size, ...robust, '-o', plan, '--poses-csv', '-', '--force', '--quiet');
      if (c.route) run('route', plan, '--from-home', '--closed', '--reading', '4', '-o', route, '--force', '--quiet');
      const data = JSON.parse(
        run('report', plan, ...(c.route ? ['--route', route] : []), '-o', page, '--force', '--quiet', '--json'),
      );
      return {
        name: c.name,
        problem,
        folder,
        page,
        plan: JSON.parse(readFileSync(plan, 'utf8')),
        data,
        route: Boolean(c.route),
      };
    });
}

import { folderOf, joined, nameOf } from './project.js';

const decoder = new TextDecoder();
const isRobot = (path, bytes) => /\.(urdf|xml|xacro)$/i.test(path) && /<robot[\s>]/.test(decoder.decode(bytes.subarray(0, 20000)));

const isProblem = (path, bytes) => /\.ya?ml$/i.test(path) && /^posewright\s*:/m.test(decoder.decode(bytes));
const isPlan = (path, bytes) => nameOf(path) === 'plan.json' || (/\.json$/i.test(path) && /^\s*\{\s*"schema"\s*:\s*"posewright\/plan\//.test(decoder.decode(bytes.subarray(0, 200))));

/** Problem files among dropped ones: one of the usual name first, whatever is in it. @param {Map<string, Uint8Array>} files */
export function problemsAmong(files) {
  const usual = ([path]) => /(^|\/)problem\.ya?ml$/.test(path);
  const problems = [...files].filter((file) => usual(file) || isProblem(...file));
  return [...problems.filter(usual), ...problems.filter((file) => !usual(file))].map(([path]) => path);
}

/** The plan among dropped files; undefined: none. @param {Map<string, Uint8Array>} files */
export function planAmong(files) {
  const plans = [...files].filter((file) => isPlan(...file)).map(([path]) => path);
  return plans.find((path) => nameOf(path) === 'plan.json') ?? plans[0];
}

/** Whether meshes are among dropped files. @param {Map<string, Uint8Array>} files */
export const hasMesh = (files) => [...files.keys()].some((path) => /\.(stl|obj|dae)$/i.test(path));

/** The robot among dropped files; undefined: none. @param {Map<string, Uint8Array>} files */
export function robotAmong(files) {
  const robots = [...files].filter(([path, bytes]) => isRobot(path, bytes)).map(([path]) => path);
  return robots.find((path) => /\.urdf$/i.test(path)) ?? robots[0];
}

/** How many names from the end two paths share. @param {string} a @param {string} b */
function commonEnd(a, b) {
  const [x, y] = [a, b].map((path) => path.split('/').reverse());
  let k = 0;
  while (k < x.length && k < y.length && x[k] === y[k]) k++;
  return k;
}

/**
 * Where the program looks for a mesh of a URDF, relative to the page's root.
 * @param {string} name as the URDF has it @param {string} robot path of the URDF
 */
function placeOf(name, robot) {
  const named = name.match(/^(?:package|model):\/\/(.+)$/);
  if (named) return named[1];
  return name.startsWith('/') || /^\w+:/.test(name) ? undefined : joined(folderOf(robot), name);
}

/** Names of meshes in a URDF. @param {string} text */
const meshNames = (text) => new Set([...text.matchAll(/<mesh\b[^>]*\bfilename\s*=\s*["']([^"']+)["']/g)].map((m) => m[1]));

/**
 * Puts loose meshes where the URDF names them, by the end of their path. Makers leave meshes for the looks out, or give them as
 * Collada: the picture does without, and no check needs them.
 * @param {Map<string, Uint8Array>} files changed @param {string} robot
 * @returns {{missing: string[], looks: string[]}} names of meshes that are not there: for checks, and for looks alone
 */
export function placeMeshes(files, robot) {
  const text = decoder.decode(files.get(robot));
  const checked = meshNames(text.replace(/<visual\b.*?<\/visual>/gs, ''));
  const lacking = [...meshNames(text)].filter((name) => {
    const place = placeOf(name, robot) ?? nameOf(name);
    if (files.has(place)) return false;
    const best = [...files.keys()]
      .map((path) => ({ path, ends: commonEnd(path, place) }))
      .reduce((a, b) => (b.ends > a.ends ? b : a), { path: '', ends: 0 });
    if (best.ends > 0) files.set(place, files.get(best.path));
    return best.ends === 0;
  });
  return { missing: lacking.filter((name) => checked.has(name)), looks: lacking.filter((name) => !checked.has(name)) };
}

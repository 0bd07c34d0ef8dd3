import { nameOf } from './project.js';

/** @typedef {{text: string, line: number, kind: 'error'|'note'}} Message line: of the problem's text, 0: none */

/** Progress, and the summary that only machines ask for. */
const progress = /^(posewright: )?\d+ tasks done|^[a-z ]+ \d+\/\d+|^\S.* best -?[\d.]+|^ +\d* ?\|/;

/** @param {string} text @param {string} problem its path @returns {Message} */
export function messageOf(text, problem) {
  const plain = text.replace(/^posewright: /, '');
  const note = /^(note|warning): /.exec(plain);
  const body = note ? plain.slice(note[0].length) : plain;
  const place = body.match(/^([^:]+):(\d+): /);
  const own = place && nameOf(place[1]) === nameOf(problem);
  return { text: own ? body.slice(place[0].length) : body, line: own ? Number(place[2]) : 0, kind: note ? 'note' : 'error' };
}

/** What the program said on stderr, without progress and the excerpts of the file that it prints. @param {string[]} err @param {string} problem */
export const messagesOf = (err, problem) =>
  err.filter((line) => line.trim() !== '' && !progress.test(line)).map((line) => messageOf(line, problem));

/** What a line of progress tells; undefined: it is none. @param {string} line */
export function progressOf(line) {
  const counted = line.match(/^([a-z ]+) (\d+)\/(\d+)/);
  if (counted) return { text: `${counted[1]} ${counted[2]} of ${counted[3]}`, share: Number(counted[2]) / Number(counted[3]) };
  const search = line.match(/^(\S+)\s+(.*best.*)$/);
  return search ? { text: line.trim() } : undefined;
}

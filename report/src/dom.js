/**
 * An element. Attributes that start with "on" are listeners, `class` is the class, everything else an attribute;
 * strings become text, never markup.
 * @param {string} tag @param {Object<string, any>} [attributes] @param {...any} children
 * @returns {any}
 */
export function h(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  assign(element, attributes);
  element.append(...children.flat().filter((c) => c !== null && c !== undefined && c !== false));
  return element;
}

/** The same in SVG. @param {string} tag @param {Object<string, any>} [attributes] @param {...any} children */
export function svg(tag, attributes = {}, ...children) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
  assign(element, attributes);
  element.append(...children.flat().filter((c) => c !== null && c !== undefined));
  return element;
}

/** @param {Element} element @param {Object<string, any>} attributes */
function assign(element, attributes) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? '' : String(value));
  }
}

/**
 * One part of the page.
 * @param {string} id @param {string} title @param {string|null} lead what it is, in one sentence @param {...any} children
 */
export function section(id, title, lead, ...children) {
  return h(
    'section',
    { id, 'aria-labelledby': `${id}-title` },
    h('h2', { id: `${id}-title` }, title),
    lead ? h('p', { class: 'lead' }, lead) : null,
    ...children,
  );
}

/**
 * A table that scrolls by itself where it is wider than the page.
 * @param {string[]} header entries that start with "#" are numbers @param {any[][]} rows @param {string} label
 */
export function table(header, rows, label) {
  const numeric = header.map((title) => title.startsWith('#'));
  const cell = (tag, content, column, extra = {}) =>
    h(tag, { class: numeric[column] ? 'number' : null, ...extra }, ...[content].flat());
  return h(
    'div',
    { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': label },
    h(
      'table',
      {},
      h(
        'thead',
        {},
        h(
          'tr',
          {},
          header.map((title, c) => cell('th', title.replace(/^#/, ''), c, { scope: 'col' })),
        ),
      ),
      h(
        'tbody',
        {},
        rows.map((row) =>
          h(
            'tr',
            {},
            row.map((content, c) => cell('td', content, c)),
          ),
        ),
      ),
    ),
  );
}

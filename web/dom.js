// Building the page from data. Whatever a user wrote goes in as text: nothing here, or anywhere on the
// page, turns a string into markup.

// h('td', {class: 'x', title: 'y', onclick: f}, 'text', anotherElement, null)
export function h(name, attributes, ...children) {
  return fill(document.createElement(name), attributes, children);
}

const SVG = 'http://www.w3.org/2000/svg';
export function svg(name, attributes, ...children) {
  return fill(document.createElementNS(SVG, name), attributes, children);
}

function fill(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === 'function') element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? '' : value);
  }
  element.append(...children.flat().filter(child => child !== null && child !== undefined && child !== false));
  return element;
}

// Replace the content only when it changed, so that a poll neither moves the focus nor loses a selection.
export function replaceIfChanged(element, key, build) {
  const text = JSON.stringify(key);
  if (element.dataset.shown === text) return;
  element.dataset.shown = text;
  element.replaceChildren(...[build()].flat(Infinity).filter(child => child !== null && child !== undefined));
}

export const byId = id => document.getElementById(id);

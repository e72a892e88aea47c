// A drawing of the page as a file that looks the same by itself: what the style sheets say of it goes along.
import { h } from './dom.js';

const OF_STYLE = ['fill', 'fill-opacity', 'stroke', 'stroke-width', 'stroke-dasharray', 'opacity', 'font-size', 'font-family', 'font-weight'];

function textOf(drawing) {
  const copy = drawing.cloneNode(true), originals = [drawing, ...drawing.querySelectorAll('*')];
  [copy, ...copy.querySelectorAll('*')].forEach((element, i) => {
    const style = getComputedStyle(originals[i]);
    for (const name of OF_STYLE) element.setAttribute(name, style.getPropertyValue(name));
    element.removeAttribute('class');
  });
  copy.setAttribute('xmlns', 'http://www.w3.org/2000/svg');
  return new XMLSerializer().serializeToString(copy);
}

export function pictureButton(drawing, name) {
  const save = () => {
    const address = URL.createObjectURL(new Blob([textOf(drawing)], { type: 'image/svg+xml' }));
    h('a', { href: address, download: `${name}.svg` }).click();
    setTimeout(() => URL.revokeObjectURL(address), 1000);
  };
  return h('button', { type: 'button', class: 'save', onclick: save }, 'Save as SVG');
}

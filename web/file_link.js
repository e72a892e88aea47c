// A link to something the daemon holds. Where the daemon asks for a token a plain link can't carry it, so the
// page fetches the file and hands it to the browser to save.
import { h } from './dom.js';
import { request, token } from './api.js';

export function fileLink(path, text, name = text) {
  const fetchAndSave = async event => {
    if (!token.read()) return;
    event.preventDefault();
    try {
      const content = URL.createObjectURL(await (await request(path, { accept: '*/*' })).blob());
      h('a', { href: content, download: name }).click();
      setTimeout(() => URL.revokeObjectURL(content), 60_000);
    } catch (error) {
      window.alert(`${name} was not fetched: ${error.message}.`);
    }
  };
  return h('a', { href: path, onclick: fetchAndSave }, text);
}

// What both pages show of their connection: live or not, what is wrong, and the question for a token. Asking to
// confirm is here, too.
import { byId, h, replaceIfChanged } from './dom.js';
import { ApiError, canBeToken, root, session } from './api.js';

export function showConnected() {
  byId('token').hidden = true;
  showTrouble('');
  replaceIfChanged(byId('connection'), 'live', () => h('span', { class: 'live' }, 'live'));
}

// refresh: what "Try now" does.
export function showFailure(error, pause, refresh) {
  if (!(error instanceof ApiError)) console.error(error);
  replaceIfChanged(byId('connection'), 'away', () => h('span', { class: 'away' }, 'not live'));
  byId('token').hidden = error.status !== 401;
  const again = `Trying again in ${Math.round(pause / 1000)} s.`;
  if (error.status === 401) showTrouble('');
  else if (isOfAddress(error)) showTrouble(`There is nothing to show at this address: ${error.message}.`, null, root);
  else if (error.status === 0) showTrouble(`The daemon is out of reach: ${error.message}. What you see may be old. ${again}`, refresh);
  else if (error.status) showTrouble(`The daemon answered ${error.status}: ${error.message} ${again}`, refresh);
  else showTrouble(`The answer was not understood: ${error.message}. ${again}`, refresh);
}

// Nothing that asking again would mend.
export const isOfAddress = error => [400, 404, 410, 414].includes(error.status);

// way: an address to go on at; '': none.
export function showTrouble(text, refresh = null, way = '') {
  byId('trouble').hidden = text === '';
  replaceIfChanged(byId('trouble'), [text, Boolean(refresh), way], () => text === '' ? [] : [
    h('span', null, text), refresh ? h('button', { onclick: refresh }, 'Try now') : null,
    way ? h('a', { href: way }, 'Show all jobs') : null]);
}

function showTokenProblem(text) {
  byId('token-problem').hidden = text === '';
  byId('token-problem').textContent = text;
}

export function takeToken(refresh) {
  byId('token').addEventListener('submit', async event => {
    event.preventDefault();
    const value = byId('token-value').value.trim();
    if (!canBeToken(value)) {
      showTokenProblem('A token has only letters, digits and signs of ASCII, without spaces; this is none.');
      return;
    }
    try {
      await session.begin(value);
      showTokenProblem('');
      byId('token-value').value = '';
      refresh();
    } catch (error) {
      showTokenProblem(error.status === 401 ? 'The daemon does not take this token: its token file has no such one.' : `${error.message}.`);
    }
  });
}

// Resolves to true when the user wants it. question, yes: in the place of the dialog's own title and of its button's text.
export async function confirmed(what, yes = '') {
  const dialog = byId('confirm'), title = byId('confirm-title'), button = dialog.querySelector('[value=cancel]');
  title.dataset.own ??= title.textContent;
  button.dataset.own ??= button.textContent;
  title.textContent = yes ? 'Are you sure?' : title.dataset.own;
  button.textContent = yes || button.dataset.own;
  byId('confirm-what').textContent = what;
  dialog.returnValue = 'keep';
  dialog.showModal();
  await new Promise(closed => dialog.addEventListener('close', closed, { once: true }));
  return dialog.returnValue === 'cancel';
}

// Where in the list one is: "51–100 of 10,035", and the ways to other parts of it.
import { h } from './dom.js';
import { count } from './format.js';

const cursorIn = links => {
  const older = links.find(link => link.rel === 'next');
  return older ? new URL(older.href, location.href).searchParams.get('cursor') : '';
};

// view.trail: cursors of the parts that lie before this one, as far as one came through them; a shared address has none.
// list: the daemon's answer; all: jobs in the list; go(change): shows another part.
export function pagesOf(view, list, all, go) {
  const next = cursorIn(list.links), shown = list.jobs.length, { cursor, at, trail, sort } = view;
  const from = cursor ? at : 0, before = trail.at(-1);
  const button = (text, change) => h('button', { type: 'button', onclick: () => go(change) }, text);
  return [
    h('span', { class: 'range' }, shown === 0 ? '' : `${count(from + 1)}–${count(from + shown)} of ${count(Math.max(all, from + shown))}`),
    cursor ? button(sort ? '« First' : '« Newest', { cursor: '', at: 0, trail: [] }) : null,
    cursor && before ? button('‹ Previous', { ...before, trail: trail.slice(0, -1) }) : null,
    next ? button('Next ›', { cursor: next, at: from + shown, trail: [...trail, { cursor, at: from }] }) : null,
    next && !sort ? button('Oldest first', { cursor: '', at: 0, trail: [], sort: 'created' }) : null,
  ].filter(Boolean);
}

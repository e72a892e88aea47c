// What is being looked at, kept in the URL so that a reload, a bookmark or a colleague sees the same:
// ?status=failed&q=table+1&value.angle_deg=30..40&sort=-angle_deg&columns=seed&cursor=...&open=ID,ID

import { root } from './api.js';
import { filterOf } from './filter.js';

export const STATES = ['accepted', 'running', 'successful', 'failed', 'dismissed'];

const WORDS = ['processID', 'q', 'study', 'sort', 'datetime', 'cursor'];

export function readView() {
  const query = new URLSearchParams(location.search);
  const status = query.get('status');
  const beginning = start => new Map([...query].filter(([name]) => name.startsWith(start)).map(([name, value]) => [name.slice(start.length), value]));
  return {
    ...Object.fromEntries(WORDS.map(name => [name, query.get(name) ?? ''])),
    status: STATES.includes(status) ? status : '',
    trail: history.state?.trail ?? [], // of list_pages.js; the history alone keeps it
    at: Math.max(0, Math.floor(Number(query.get('at')) || 0)), // how many jobs come before those shown
    labels: beginning('label.'), values: beginning('value.'),
    columns: (query.get('columns') ?? '').split(',').filter(Boolean),
    open: new Set((query.get('open') ?? '').split(',').filter(Boolean)),
  };
}

export const isFiltered = view => filterOf(view).size > 0;

export function addressOf(view) {
  const query = filterOf(view), { sort, columns, cursor, at, open } = view;
  if (sort) query.set('sort', sort);
  if (columns?.length) query.set('columns', columns.join(','));
  if (cursor) query.set('cursor', cursor);
  if (cursor && at) query.set('at', at);
  if (open?.size) query.set('open', [...open].join(','));
  const text = query.toString();
  return text ? `${root}?${text}` : root;
}

// Another list is a step the back button can undo; typing a search or opening a row is not.
export function writeView(view, { step = false } = {}) {
  history[step ? 'pushState' : 'replaceState']({ trail: view.trail }, '', addressOf(view));
}

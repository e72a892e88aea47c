// What is being looked at, kept in the URL so that a reload, a bookmark or a colleague sees the same:
// ?status=failed&q=table+1&study=ID&cursor=...&open=ID,ID

import { root } from './api.js';

export const STATES = ['accepted', 'running', 'successful', 'failed', 'dismissed'];

export function readView() {
  const query = new URLSearchParams(location.search);
  const status = query.get('status');
  return {
    status: STATES.includes(status) ? status : '',
    q: query.get('q') ?? '',
    study: query.get('study') ?? '',
    cursor: query.get('cursor') ?? '',
    open: new Set((query.get('open') ?? '').split(',').filter(Boolean)),
  };
}

export function addressOf({ status, q, study, cursor, open }) {
  const query = new URLSearchParams();
  if (status) query.set('status', status);
  if (q) query.set('q', q);
  if (study) query.set('study', study);
  if (cursor) query.set('cursor', cursor);
  if (open?.size) query.set('open', [...open].join(','));
  const text = query.toString();
  return text ? `${root}?${text}` : root;
}

// Another list is a step the back button can undo; typing a search or opening a row is not.
export function writeView(view, { step = false } = {}) {
  history[step ? 'pushState' : 'replaceState'](null, '', addressOf(view));
}

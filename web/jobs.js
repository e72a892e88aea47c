// The page: one list of jobs, newest first, never more of them than a page. It reads the view from the URL,
// asks the daemon for that list again and again, and shows what changed.
import { byId, h, replaceIfChanged } from './dom.js';
import { dismissJob, listJobs, root, session } from './api.js';
import { confirmed, isOfAddress, showConnected, showFailure, showTrouble, takeToken } from './connection.js';
import { answerInWords, count } from './format.js';
import { nameOf } from './job_name.js';
import { createRow } from './job_row.js';
import { startPolling } from './polling.js';
import { addressOf, readView, STATES, writeView } from './view.js';
import { learnInputs } from './words.js';

const PAGE = 50;      // jobs a page
const TYPING = 250;   // ms without a key before a search is sent

let view = readView();
const filters = new Map(['', ...STATES].map(status => [status, createFilter(status)]));
byId('states').append(...filters.values());
let rows = new Map(); // by job id, in the order shown
const refresh = startPolling(ask, (error, pause) => {
  showFailure(error, pause, refresh);
  if (isOfAddress(error)) for (const part of ['jobs', 'empty', 'pages']) byId(part).hidden = true;
});
takeToken(refresh);

async function ask() {
  const asked = view;
  const list = await listJobs({ ...asked, limit: PAGE });
  await learnInputs(list.jobs);
  if (asked !== view) return true; // the view changed meanwhile: this answer is of the old one
  showConnected();
  showStates(list.counts);
  showRows(list.jobs);
  showPages(list.links);
  showEmptiness(list);
  showStudy();
  return (list.counts?.accepted ?? 0) + (list.counts?.running ?? 0) > 0;
}

function go(change, { step = true } = {}) {
  view = { ...view, ...change };
  writeView(view, { step });
  refresh();
}

function showStates(counts = {}) {
  const all = STATES.reduce((sum, state) => sum + (counts[state] ?? 0), 0);
  const running = counts.running ?? 0;
  document.title = running ? `(${running} running) reposed` : 'reposed: jobs';
  for (const [status, link] of filters) {
    link.href = addressOf({ status, q: view.q, study: view.study });
    if (view.status === status) link.setAttribute('aria-current', 'true'); else link.removeAttribute('aria-current');
    link.lastElementChild.textContent = count(status ? counts[status] ?? 0 : all);
  }
}

// Made once and only written to: a link that is made anew at a poll would lose the focus.
function createFilter(status) {
  const follow = event => {
    if (event.metaKey || event.ctrlKey || event.shiftKey) return; // a new tab or window is the browser's business
    event.preventDefault();
    go({ status, cursor: '' });
  };
  return h('a', { class: `filter ${status || 'all'}`, href: addressOf({ status }), onclick: follow },
    `${status || 'all'} `, h('span', { class: 'count' }));
}

function showRows(jobs) {
  const body = byId('rows');
  const shown = new Map();
  for (const job of jobs) shown.set(job.jobID, rows.get(job.jobID) ?? createRow(job.jobID, { toggle, stop }));
  for (const [id, row] of rows) if (!shown.has(id)) { row.main.remove(); row.below.remove(); }
  let next = body.firstElementChild; // rows already in place stay untouched, so the focus stays too
  for (const job of jobs) {
    const row = shown.get(job.jobID);
    announceChange(row.job, job);
    row.update(job, view.open.has(job.jobID));
    if (row.main === next) next = row.below.nextElementSibling;
    else { body.insertBefore(row.main, next); body.insertBefore(row.below, next); }
  }
  rows = shown;
}

function announceChange(before, now) {
  if (!before || before.status === now.status) return;
  const answer = answerInWords(now);
  byId('announcements').textContent = `${nameOf(now)}: ${now.status}${answer ? `, ${answer}` : ''}`;
}

function toggle(id) {
  const open = new Set(view.open);
  if (!open.delete(id)) open.add(id);
  view = { ...view, open };
  writeView(view);
  const row = rows.get(id);
  row.update(row.job, open.has(id));
  refresh();
}

async function stop(job) {
  if (!await confirmed(nameOf(job))) return;
  try {
    await dismissJob(job.jobID);
    byId('announcements').textContent = `${nameOf(job)}: cancelled`;
  } catch (error) {
    showTrouble(`${nameOf(job)} was not cancelled: ${error.message}.`);
  }
  refresh();
}

function showPages(links = []) {
  const older = links.find(link => link.rel === 'next');
  const cursor = older ? new URL(older.href, location.href).searchParams.get('cursor') : '';
  byId('pages').hidden = !cursor && !view.cursor;
  replaceIfChanged(byId('pages'), [cursor, view.cursor, view.status, view.q], () => [
    view.cursor ? pageLink('← Newest', '') : null,
    cursor ? pageLink('Older →', cursor) : h('span', { class: 'quiet' }, 'No older jobs.')]);
}

function pageLink(text, cursor) {
  const follow = event => {
    if (event.metaKey || event.ctrlKey || event.shiftKey) return;
    event.preventDefault();
    go({ cursor });
    byId('jobs').focus();
    window.scrollTo(0, 0);
  };
  return h('a', { href: addressOf({ ...view, open: null, cursor }), onclick: follow }, text);
}

function showStudy() {
  byId('of-study').hidden = !view.study;
  if (view.study) replaceIfChanged(byId('of-study'), view.study, () => [
    h('span', null, 'Only jobs of the study ', h('a', { href: `${root}web/studies.html#${view.study}` }, view.study)), h('a', { href: root }, 'Show all jobs')]);
}

function showEmptiness(list) {
  const nothing = list.jobs.length === 0;
  byId('jobs').hidden = nothing;
  byId('empty').hidden = !nothing;
  const filtered = Boolean(view.status || view.q || view.cursor || view.study);
  if (nothing) replaceIfChanged(byId('empty'), [filtered, view.status, view.q], () => filtered ? noMatch() : firstJob());
}

function noMatch() {
  const wanted = [view.status && `${view.status}`, view.q && `matching “${view.q}”`].filter(Boolean).join(', ');
  return [h('h2', null, 'No such jobs'), h('p', null, `Nothing here is ${wanted || 'that old'}.`),
    h('p', null, h('a', { href: root }, 'Show all jobs'))];
}

function firstJob() {
  const inputs = { drum: { diameter: 0.126, length: 0.0189, rotation_rate: 1.5708 },
    particles: [{ diameter: 0.00378 }], contact: { friction: 0.1 } };
  const bearer = session.isAsked() ? ' -H "Authorization: Bearer $(cat TOKEN_FILE)"' : '';
  return [h('h2', null, 'No jobs yet'),
    h('p', null, 'Two lines in a terminal submit the first one, a drum of 126 mm half full of glass beads, and watch it:'),
    h('pre', { tabindex: '0' }, h('code', null,
      `curl${bearer} ${location.origin}/processes/drum/execution \\\n  --json '${JSON.stringify({ inputs })}'\n`
      + `curl${bearer} '${location.origin}/jobs?limit=1'`)),
    h('p', null, 'It appears here by itself. ', h('a', { href: `${root}processes/drum` }, 'Every input'),
      ' has a unit, a range and, but for the drum and its particles, a default.')];
}

byId('q').value = view.q;
let typing = 0;
byId('q').addEventListener('input', () => {
  clearTimeout(typing);
  typing = setTimeout(() => go({ q: byId('q').value.trim(), cursor: '' }, { step: false }), TYPING);
});
byId('search').addEventListener('submit', event => {
  event.preventDefault();
  go({ q: byId('q').value.trim(), cursor: '' }, { step: false });
});
window.addEventListener('popstate', () => {
  view = readView();
  byId('q').value = view.q;
  refresh();
});

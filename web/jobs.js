// The page: one list of jobs, newest first, never more of them than a page. It reads the view from the URL,
// asks the daemon for that list again and again, and shows what changed.
import { byId, h, replaceIfChanged } from './dom.js';
import { dismissJob, json, listJobs, root, session } from './api.js';
import { confirmed, isOfAddress, showConnected, showFailure, showTrouble, takeToken } from './connection.js';
import { answerInWords, count } from './format.js';
import { nameOf } from './job_name.js';
import { createRow } from './job_row.js';
import { columnsOf, headingOf } from './columns.js';
import { filterOf } from './filter.js';
import { chipsOf, filterPanel } from './list_filters.js';
import { pagesOf } from './list_pages.js';
import { knownPlaces, learnPlaces } from './list_places.js';
import { createSelection, selectionBar } from './list_selection.js';
import { startPolling } from './polling.js';
import { addressOf, isFiltered, readView, STATES, writeView } from './view.js';
import { describe, learnInputs } from './words.js';

const PAGE = 50;      // jobs a page
const ACTIVE = 40;    // of those that run or wait, above them
const ENDED = 'successful,failed,dismissed';
const TYPING = 250;   // ms without a key before a search is sent

let view = readView();
const filters = new Map(['', ...STATES].map(status => [status, createFilter(status)]));
byId('states').append(...filters.values());
let rows = new Map(); // by job id, in the order shown
const words = new Set(); // processes whose inputs have words
let columns = [], processes = []; // what is known of the processes; asked for once
let shownList = null;
let hadActive = false; // whether anything ran or waited at the last look
const selection = createSelection(() => shownList && showList(shownList));
const refresh = startPolling(ask, (error, pause) => {
  showFailure(error, pause, refresh);
  if (isOfAddress(error)) for (const part of ['jobs', 'empty', 'pages', 'narrow']) byId(part).hidden = true;
});
takeToken(refresh);

// In the usual order what runs and waits stands above what has ended; else the list is as it was asked for.
function isUsual() {
  return view.sort === '' && view.status === '';
}
function listed() {
  return { ...view, status: isUsual() ? ENDED : view.status };
}

async function ask() {
  const asked = view;
  const mayHaveActive = isUsual() && !asked.cursor;
  // Asked for before the others: a job that ends meanwhile is then in both answers, not in none.
  let first = mayHaveActive && hadActive ? await listActive(asked) : [];
  const list = await listJobs({ ...listed(), limit: PAGE });
  const active = (list.counts?.accepted ?? 0) + (list.counts?.running ?? 0);
  if (mayHaveActive && active > 0 && !hadActive) first = await listActive(asked);
  hadActive = active > 0;
  first = first.filter(job => !list.jobs.some(one => one.jobID === job.jobID)).sort(byPlace);
  if (asked !== view) return true; // the view changed meanwhile: this answer is of the old one
  showConnected();
  knownPlaces([...first, ...list.jobs]);
  showList({ ...list, first });
  showPlaces(first);
  if (await learnWords(asked, [...first, ...list.jobs]) && asked === view) showList({ ...list, first });
  return active > 0;
}

// What the processes call their inputs and results, asked for once and when it is needed: rows are there before. Whether it is new.
async function learnWords(asked, jobs) {
  const before = columns.length, isNew = jobs.some(job => !words.has(job.processID));
  await learnInputs(jobs);
  for (const job of jobs) words.add(job.processID);
  if (byId('narrow').open || asked.sort || asked.columns.length || asked.values.size) await learnColumns();
  return isNew || columns.length > before;
}
byId('narrow').addEventListener('toggle', () => { if (byId('narrow').open && columns.length === 0) refresh(); });

// After the list, which does not wait for them.
async function showPlaces(jobs) {
  if (!await learnPlaces(jobs)) return;
  knownPlaces(jobs);
  for (const job of jobs) if (rows.get(job.jobID)?.job === job) rows.get(job.jobID).update(job, view.open.has(job.jobID), { columns: chosen(), picked: selection.has(job.jobID) });
}

async function listActive(asked) {
  return (await listJobs({ ...asked, status: 'running,accepted', sort: 'created', limit: ACTIVE })).jobs;
}

const byPlace = (a, b) => (a.status !== 'running') - (b.status !== 'running') || (a.position ?? 0) - (b.position ?? 0);

async function learnColumns() {
  if (columns.length > 0) return;
  ({ processes } = await json(`${root}processes`));
  columns = columnsOf(await Promise.all(processes.map(({ id }) => describe(id))));
}

function showList(list) {
  shownList = list;
  const jobs = [...list.first, ...list.jobs];
  showStates(list.counts);
  showNarrowing();
  showHead(jobs);
  showRows(jobs);
  showMore(list);
  showPages(list);
  showSelection(jobs, list.counts);
  showEmptiness(jobs);
  showStudy();
}

const sumOf = (counts = {}, states = STATES) => states.reduce((sum, state) => sum + (counts[state] ?? 0), 0);
const allIn = counts => sumOf(counts, view.status ? [view.status] : isUsual() ? ENDED.split(',') : STATES);

function go(change, { step = true } = {}) {
  view = { ...view, ...change };
  if (Object.keys(change).some(name => !['columns', 'cursor', 'at', 'sort'].includes(name))) selection.clear();
  writeView(view, { step });
  refresh();
}

function showStates(counts = {}) {
  const all = sumOf(counts);
  const running = counts.running ?? 0;
  document.title = running ? `(${running} running) reposed` : 'reposed: jobs';
  for (const [status, link] of filters) {
    link.href = addressOf({ ...view, status, cursor: '', open: null });
    if (view.status === status) link.setAttribute('aria-current', 'true'); else link.removeAttribute('aria-current');
    link.lastElementChild.textContent = count(status ? counts[status] ?? 0 : all);
  }
}

// Made once and only written to: a link that is made anew at a poll would lose the focus.
function createFilter(status) {
  const follow = event => {
    if (event.metaKey || event.ctrlKey || event.shiftKey) return; // a new tab or window is the browser's business
    event.preventDefault();
    go({ status, cursor: '', at: 0 });
  };
  return h('a', { class: `filter ${status || 'all'}`, href: addressOf({ status }), onclick: follow },
    `${status || 'all'} `, h('span', { class: 'count' }));
}

function showRows(jobs) {
  const body = byId('rows');
  const shown = new Map();
  for (const job of jobs) shown.set(job.jobID, rows.get(job.jobID) ?? createRow(job.jobID, { toggle, stop, pick: selection.set }));
  for (const [id, row] of rows) if (!shown.has(id)) { row.main.remove(); row.below.remove(); }
  let next = body.firstElementChild; // rows already in place stay untouched, so the focus stays too
  for (const job of jobs) {
    const row = shown.get(job.jobID);
    announceChange(row.job, job);
    selection.see(job);
    row.update(job, view.open.has(job.jobID), { columns: chosen(), picked: selection.has(job.jobID) });
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
  row.update(row.job, open.has(id), { columns: chosen(), picked: selection.has(id) });
  refresh();
}

async function stop(job) {
  if (!await confirmed(`${nameOf(job)} (${job.jobID})`)) return;
  try {
    await dismissJob(job.jobID);
    byId('announcements').textContent = `${nameOf(job)}: cancelled`;
  } catch (error) {
    showTrouble(`${nameOf(job)} was not cancelled: ${error.message}.`);
  }
  refresh();
}

function showPages(list) {
  const all = allIn(list.counts);
  byId('pages').hidden = list.jobs.length === 0 || (all <= PAGE && !view.cursor);
  replaceIfChanged(byId('pages'), [list.links, view.cursor, view.at, all, list.jobs.length], () => pagesOf(view, list, all, change => {
    go(change);
    byId('jobs').focus();
    window.scrollTo(0, 0);
  }));
}

// Of those that run and wait only so many are shown here.
function showMore({ first, counts }) {
  const left = sumOf(counts, ['accepted', 'running']) - first.length;
  byId('more').hidden = first.length === 0 || left <= 0;
  replaceIfChanged(byId('more'), [left, first.length], () => left > 0 && first.length > 0 ? [`${count(left)} more wait: `, h('a', { href: addressOf({ ...view, status: 'accepted' }) }, 'all that wait')] : []);
}

const chosen = () => view.columns.map(name => columns.find(column => column.name === name)).filter(Boolean);

function showNarrowing() {
  byId('narrow').hidden = false;
  const key = [view.processID, view.sort, view.datetime, [...view.labels], [...view.values], view.columns, columns.length];
  replaceIfChanged(byId('filters'), key, () => filterPanel(view, processes, columns, go));
  replaceIfChanged(byId('chips'), key, () => chipsOf(view, columns, go));
}

// The heads, which sort. Made anew only when they change.
const HEADS = [['Job', 'created'], ['State', 'progress'], ['Inputs', ''], ['Result', 'angle_deg'], ['Regime', 'regime'], ['Times', 'created']];
function showHead(jobs) {
  const every = jobs.length > 0 && jobs.every(job => selection.has(job.jobID));
  const head = (text, name) => h('th', { role: 'columnheader', scope: 'col', 'aria-sort': view.sort === name && name ? 'ascending' : view.sort === `-${name}` ? 'descending' : null },
    name ? h('button', { class: 'sorter', type: 'button', onclick: () => go({ sort: view.sort === `-${name}` ? name : view.sort === name ? '' : `-${name}`, cursor: '', at: 0 }) }, text) : text);
  replaceIfChanged(byId('heads'), [view.sort, view.columns, every, columns.length], () => [
    h('th', { role: 'columnheader', scope: 'col', class: 'pick' }, h('label', null, h('input', { type: 'checkbox', checked: every, 'aria-label': 'Select all of this page',
      onchange: event => selection.setPage([...shownList.first, ...shownList.jobs], event.target.checked) }))),
    ...HEADS.map(([text, name]) => head(text, name)), ...chosen().map(column => head(headingOf(column), column.name)),
    h('th', { role: 'columnheader', scope: 'col' }, h('span', { class: 'unseen' }, 'Actions'))]);
}

function showSelection(jobs, counts) {
  const total = sumOf(counts, view.status ? [view.status] : STATES);
  byId('selection').hidden = !selection.isAll() && selection.jobs().length === 0;
  replaceIfChanged(byId('selection'), [selection.isAll(), selection.jobs().map(job => job.jobID), total], () => selectionBar(selection, total, filterOf(view), confirmed, text => {
    byId('announcements').textContent = text;
    selection.clear();
    refresh();
  }));
}

function showStudy() {
  byId('of-study').hidden = !view.study;
  if (view.study) replaceIfChanged(byId('of-study'), view.study, () => [
    h('span', null, 'Only jobs of the study ', h('a', { href: `${root}web/studies.html#${view.study}` }, view.study)), h('a', { href: root }, 'Show all jobs')]);
}

function showEmptiness(jobs) {
  const nothing = jobs.length === 0;
  byId('jobs').hidden = nothing;
  byId('empty').hidden = !nothing;
  const filtered = Boolean(isFiltered(view) || view.cursor);
  if (nothing) replaceIfChanged(byId('empty'), [filtered, view.status, view.q, view.cursor], () => filtered ? noMatch() : firstJob());
}

function noMatch() {
  const wanted = [view.status, view.q && `matching “${view.q}”`].filter(Boolean).join(', ');
  return [h('h2', null, 'No such jobs'), h('p', null, wanted ? `Nothing here is ${wanted}.` : view.cursor ? 'Nothing here is that old.' : 'No job passes these filters.'),
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
  typing = setTimeout(() => go({ q: byId('q').value.trim(), cursor: '', at: 0 }, { step: false }), TYPING);
});
byId('search').addEventListener('submit', event => {
  event.preventDefault();
  go({ q: byId('q').value.trim(), cursor: '', at: 0 }, { step: false });
});
window.addEventListener('popstate', () => {
  view = readView();
  byId('q').value = view.q;
  refresh();
});

// The page of calibrations: a list, newest first, or one calibration, the one that the address names after its #.
import { byId, h, replaceIfChanged } from './dom.js';
import { calibrationPath, dismissCalibration, json, retryCalibration, root } from './api.js';
import { calibrationNames } from './calibration_names.js';
import { calibrationView } from './calibration_view.js';
import { confirmed, isOfAddress, showConnected, showFailure, showTrouble, takeToken } from './connection.js';
import { fileLink } from './file_link.js';
import { clock, count, duration, secondsBetween } from './format.js';
import { startPolling } from './polling.js';

const PAGE = 50; // calibrations a page

let cursor = ''; // where the list begins; '': at the newest
let shown = null; // {id, status, updated} of the calibration that is on the page
const refresh = startPolling(ask, (error, pause) => {
  showFailure(error, pause, refresh);
  if (isOfAddress(error)) for (const part of ['list', 'calibration']) byId(part).hidden = true;
});
takeToken(refresh);
window.addEventListener('hashchange', refresh);

// What is no encoding of anything is no calibration's id either.
function wanted() {
  try {
    return decodeURIComponent(location.hash.slice(1));
  } catch {
    return location.hash.slice(1);
  }
}

async function ask() {
  return wanted() ? askForOne(wanted()) : askForList();
}

function hasEnded({ status }) {
  return status !== 'accepted' && status !== 'running';
}

// --- the list ---

async function askForList() {
  const { calibrations, links } = await json(`${root}calibrations?limit=${PAGE}${cursor ? `&cursor=${cursor}` : ''}`);
  if (wanted()) return true;
  showConnected();
  document.title = 'reposed: calibrations';
  byId('calibration').hidden = true;
  byId('list').hidden = false;
  byId('calibrations').hidden = calibrations.length === 0;
  byId('empty').hidden = calibrations.length > 0;
  replaceIfChanged(byId('rows'), calibrations, () => calibrations.map(row));
  if (calibrations.length === 0) replaceIfChanged(byId('empty'), cursor, firstOne);
  const older = links.find(link => link.rel === 'next');
  const next = older ? new URL(older.href, location.href).searchParams.get('cursor') : '';
  byId('pages').hidden = !next && !cursor;
  const way = (text, to) => h('button', { onclick: () => { cursor = to; refresh(); } }, text);
  replaceIfChanged(byId('pages'), [next, cursor], () => [cursor ? way('← Newest', '') : null, next ? way('Older →', next) : null]);
  return calibrations.some(one => !hasEnded(one));
}

function row(one) {
  return h('tr', { id: `calibration-${one.calibrationID}` },
    h('th', { scope: 'row' }, h('a', { href: `#${one.calibrationID}` }, one.name), h('small', null, one.calibrationID)),
    h('td', null, state(one)),
    h('td', null, count(one.jobs), h('small', null, `at most ${count(one.most_jobs)}`)),
    h('td', null, h('time', { datetime: one.created, title: one.created }, clock(one.created))));
}

function state(one) {
  return [h('span', { class: `badge ${one.status}` }, one.status),
    hasEnded(one) ? null : h('progress', { max: 100, value: one.progress, 'aria-label': 'progress' }),
    h('small', null, one.message, hasEnded(one) || one.eta_seconds === undefined ? null : `, about ${duration(one.eta_seconds)} left`)];
}

function firstOne() {
  return [h('h2', null, 'No calibrations yet'),
    h('p', null, 'A calibration has measured values and asks which inputs give them: every set that does, and which test would tell more. An example that takes some minutes is among the ',
      h('a', { href: `${root}examples` }, 'ready ones'), ':'),
    h('pre', { tabindex: '0' }, h('code', null, `curl ${location.origin}${root}examples/calibration | curl --json @- ${location.origin}${root}calibrations`))];
}

// --- one calibration ---

async function askForOne(id) {
  const one = await json(calibrationPath(id));
  const isNew = shown?.id !== id || shown.updated !== one.updated || shown.status !== one.status;
  const [request, results] = isNew ? await Promise.all([json(`${calibrationPath(id)}/spec`), json(`${calibrationPath(id)}/results`)]) : [];
  const names = isNew ? await calibrationNames(request) : null;
  if (wanted() !== id) return true;
  showConnected();
  if (shown?.id === id && shown.status !== one.status) byId('announcements').textContent = `${one.name}: ${one.status}`;
  document.title = `${one.name}: ${one.status}`;
  byId('list').hidden = true;
  byId('calibration').hidden = false;
  if (shown?.id !== id) byId('calibration').replaceChildren(h('div', { id: 'head' }), h('div', { id: 'found' }), links(id));
  replaceIfChanged(byId('head'), one, () => head(one));
  if (isNew) replaceIfChanged(byId('found'), results, () => calibrationView(request, results, names));
  shown = { id, status: one.status, updated: one.updated };
  return !hasEnded(one);
}

function head(one) {
  const took = secondsBetween(one.started, one.finished);
  return [h('p', null, h('a', { href: '#' }, '← All calibrations')),
    h('div', { class: 'calibration-head' }, h('h1', null, one.name), h('span', null, state(one)),
      hasEnded(one) ? null : h('button', { class: 'stop', onclick: () => stop(one) }, 'Cancel'),
      ['failed', 'dismissed'].includes(one.status) ? h('button', { class: 'again', onclick: () => goOn(one) }, 'Go on') : null),
    h('p', { class: 'quiet' }, `${count(one.jobs)} jobs, at most ${count(one.most_jobs)}; submitted ${clock(one.created)}${took === null ? '' : `, took ${duration(took)}`}`)];
}

function links(id) {
  const path = calibrationPath(id);
  return h('ul', { class: 'links' },
    h('li', null, fileLink(`${path}/results.csv`, 'Runs (CSV)')),
    h('li', null, fileLink(`${path}/results`, 'Results (JSON)')),
    h('li', null, fileLink(`${path}/spec`, 'Request')),
    h('li', null, h('a', { href: `${root}?label.calibrationID=${encodeURIComponent(id)}` }, 'Its jobs')));
}

async function stop(one) {
  if (!await confirmed(one.name)) return;
  await change(one, dismissCalibration, 'cancelled');
}

async function goOn(one) {
  await change(one, retryCalibration, 'started again');
}

async function change(one, ask, what) {
  try {
    await ask(one.calibrationID);
    byId('announcements').textContent = `${one.name}: ${what}`;
  } catch (error) {
    showTrouble(`${one.name} was not ${what}: ${error.message}.`);
  }
  refresh();
}

// The page of studies: a list, newest first, or one study, the one that the address names after its #.
import { byId, h, replaceIfChanged } from './dom.js';
import { dismissStudy, json, root, studyPath, session } from './api.js';
import { confirmed, isOfAddress, showConnected, showFailure, showTrouble, takeToken } from './connection.js';
import { clock, count, duration, secondsBetween } from './format.js';
import { startPolling } from './polling.js';
import { createStudyData } from './study_data.js';
import { createStudyView } from './study_view.js';
import { describe } from './words.js';
import { fileLink } from './file_link.js';

const PAGE = 50; // studies a page

let cursor = ''; // where the list begins; '': at the newest
let shown = null; // {id, status, data, view} of the study that is on the page
const refresh = startPolling(ask, (error, pause) => {
  showFailure(error, pause, refresh);
  if (isOfAddress(error)) for (const part of ['list', 'study']) byId(part).hidden = true;
});
takeToken(refresh);
window.addEventListener('hashchange', refresh);

// The address names the study, and behind & what is drawn. What is no encoding of anything is no study's id either.
function wanted() {
  const [id] = location.hash.slice(1).split('&');
  try {
    return decodeURIComponent(id);
  } catch {
    return id;
  }
}

async function ask() {
  return wanted() ? askForStudy(wanted()) : askForList();
}

const hasEnded = study => study.status !== 'accepted' && study.status !== 'running';

const casesOf = study => study.cases === 1 ? '1 case' : `${count(study.cases)} cases`;

// --- the list ---

async function askForList() {
  const { studies, links } = await json(`${root}studies?limit=${PAGE}${cursor ? `&cursor=${cursor}` : ''}`);
  if (wanted()) return true;
  showConnected();
  document.title = 'reposed: studies';
  byId('study').hidden = true;
  byId('list').hidden = false;
  byId('studies').hidden = studies.length === 0;
  byId('empty').hidden = studies.length > 0;
  replaceIfChanged(byId('rows'), studies, () => studies.map(row));
  if (studies.length === 0) replaceIfChanged(byId('empty'), cursor, firstStudy);
  showPages(links);
  return studies.some(study => !hasEnded(study));
}

function row(study) {
  return h('tr', { id: `study-${study.studyID}` },
    h('th', { scope: 'row' }, h('a', { href: `#${study.studyID}` }, study.name), h('small', null, study.studyID)),
    h('td', null, state(study)),
    h('td', null, `${count(study.jobs)}`, h('small', null, `${casesOf(study)} × ${count(study.repeats)}`)),
    h('td', null, h('time', { datetime: study.created, title: study.created }, clock(study.created))));
}

function state(study) {
  return [h('span', { class: `badge ${study.status}` }, study.status),
    hasEnded(study) ? null : h('progress', { max: 100, value: study.progress, 'aria-label': 'progress' }),
    h('small', null, study.message)];
}

function showPages(links) {
  const older = links.find(link => link.rel === 'next');
  const next = older ? new URL(older.href, location.href).searchParams.get('cursor') : '';
  byId('pages').hidden = !next && !cursor;
  replaceIfChanged(byId('pages'), [next, cursor], () => [
    cursor ? pageButton('← Newest', '') : null, next ? pageButton('Older →', next) : h('span', { class: 'quiet' }, 'No older studies.')]);
}

function pageButton(text, to) {
  return h('button', { onclick: () => { cursor = to; refresh(); } }, text);
}

function firstStudy() {
  const study = { name: 'friction', base: { inputs: { drum: { diameter: 0.126, length: 0.0189, rotation_rate: 1.5708 },
    particles: [{ diameter: 0.00378 }] } }, vary: { '/inputs/contact/friction': [0.1, 0.2, 0.5] }, repeats: 2 };
  const bearer = session.isAsked() ? ' -H "Authorization: Bearer $(cat TOKEN_FILE)"' : '';
  return [h('h2', null, 'No studies yet'),
    h('p', null, 'A study is many tests from one document: lists of values in all combinations, or cases, times repeats with other seeds. This line submits six jobs:'),
    h('pre', { tabindex: '0' }, h('code', null, `curl${bearer} ${location.origin}/studies \\\n  --json '${JSON.stringify(study)}'`)),
    h('p', null, 'Ready-made ones, the paper’s Table 1 among them, are in api/studies/.')];
}

// --- one study ---

async function askForStudy(id) {
  const study = await json(studyPath(id));
  const description = await describe(study.processID);
  const data = shown?.id === id ? shown.data : createStudyData(id);
  const isNew = await data.follow(study, Object.keys(data.cases.find(Boolean)?.results ?? {}));
  if (wanted() !== id) return true;
  showConnected();
  announceChange(study);
  document.title = `${study.name}: ${study.status}`;
  byId('list').hidden = true;
  byId('study').hidden = false;
  if (shown?.id !== id) {
    const view = createStudyView(data, description);
    byId('study').replaceChildren(h('div', { id: 'head' }), view.plots, h('div', { id: 'links' }), view.table, view.shared);
    shown = { id, data, view };
  }
  replaceIfChanged(byId('head'), study, () => head(study));
  replaceIfChanged(byId('links'), id, () => links(id));
  if (isNew) shown.view.show(study);
  shown.status = study.status;
  return !hasEnded(study) || !data.isWhole(study);
}

function announceChange(study) {
  if (shown?.id === study.studyID && shown.status !== study.status)
    byId('announcements').textContent = `${study.name}: ${study.status}`;
}

function head(study) {
  const took = secondsBetween(study.started, study.finished);
  return [h('p', null, h('a', { href: '#' }, '← All studies')),
    h('div', { class: 'study-head' }, h('h1', null, study.name), h('span', null, state(study)),
      hasEnded(study) ? null : h('button', { class: 'stop', onclick: () => stop(study) }, 'Cancel'),
      h('button', { type: 'button', class: 'print', onclick: () => globalThis.print() }, 'Print')),
    h('p', { class: 'quiet' }, `${casesOf(study)}, ${study.repeats > 1 ? `each ${count(study.repeats)} times` : 'once'}; submitted ${clock(study.created)}`
      + (took === null ? '' : `, took ${duration(took)}`))];
}

function links(id) {
  const path = studyPath(id);
  return h('ul', { class: 'links' },
    h('li', null, fileLink(`${path}/results.csv`, 'Results (CSV)')),
    h('li', null, fileLink(`${path}/results`, 'Results (JSON)')),
    h('li', null, fileLink(`${path}/spec`, 'Study')),
    h('li', null, h('a', { href: `${root}?study=${encodeURIComponent(id)}` }, 'Its jobs')));
}

async function stop(study) {
  if (!await confirmed(study.name)) return;
  try {
    await dismissStudy(study.studyID);
    byId('announcements').textContent = `${study.name}: cancelled`;
  } catch (error) {
    showTrouble(`${study.name} was not cancelled: ${error.message}.`);
  }
  refresh();
}

// One job in the list: a row, and under it a row for the details that opens and closes. Rows are kept from
// poll to poll and only their changed cells are written.
import { h, replaceIfChanged } from './dom.js';
import { answerInWords, clock, count, duration, regimeInWords, secondsBetween, significant, verdictInWords } from './format.js';
import { drumPicture } from './drum_picture.js';
import { nameOf } from './job_name.js';
import { inputsInWords } from './words.js';
import { cellOf, headingOf } from './columns.js';
import { root } from './api.js';

const COLUMNS = ['pick', 'job', 'state', 'inputs', 'angle', 'regime', 'times', 'actions'];
const CAN_BE_STOPPED = ['accepted', 'running'];

const PICTURE_AFTER = 20; // s of running from which on there is one

// Where a job's picture is; undefined while it has none.
function pictureOf(job) {
  const isThere = job.status === 'successful' || job.status === 'running' && secondsBetween(job.started, new Date().toISOString()) > PICTURE_AFTER;
  return isThere ? job.links?.find(link => link.rel === 'picture')?.href : undefined;
}

// A job of an earlier version has no picture: then, of a drum, its angle is drawn.
function thumbnail(job, picture) {
  const instead = event => event.target.replaceWith(job.processID === 'drum' ? drumPicture(job.summary ?? {}, 48) : '');
  return h('a', { class: 'thumb', href: pageOf(job), tabindex: '-1', 'aria-hidden': 'true' },
    h('img', { src: `${picture}?width=96`, alt: '', width: 48, height: 48, loading: 'lazy', onerror: instead }));
}

const pageOf = job => `${root}web/job.html?id=${encodeURIComponent(job.jobID)}`;

const nothing = () => h('span', { class: 'quiet nothing' }, '–');

// actions: {toggle(id), stop(job), pick(job, on)}
export function createRow(id, actions) {
  const cells = Object.fromEntries(COLUMNS.map(name => [name, h('td', { class: name, role: 'cell' })]));
  const main = h('tr', { class: 'job', role: 'row', id: `job-${id}` }, Object.values(cells));
  const room = h('td', { role: 'cell', colspan: COLUMNS.length });
  const below = h('tr', { class: 'detail', role: 'row', id: `detail-${id}`, hidden: true }, room);
  const row = { id, main, below, job: null, detail: null };
  const box = h('input', { type: 'checkbox', onchange: event => actions.pick(row.job, event.target.checked) });
  cells.pick.append(h('label', null, box));
  let others = [];

  // columns: those beside the usual ones, as {cells of columns.js}.
  row.update = (job, open, { columns = [], picked = false } = {}) => {
    row.job = job;
    box.checked = picked;
    box.setAttribute('aria-label', `Select ${nameOf(job)}, ${job.jobID}`);
    others = showOthers(main, cells.actions, others, columns, job);
    room.colSpan = COLUMNS.length + columns.length;
    main.dataset.status = job.status;
    showName(cells.job, job, open, actions);
    showState(cells.state, job);
    showInputs(cells.inputs, job);
    showAnswer(cells.angle, job);
    showRegime(cells.regime, job.summary ?? {});
    showTimes(cells.times, job);
    showActions(cells.actions, job, row, actions);
    main.classList.toggle('open', open);
    below.hidden = !open;
    if (open) showDetail(row, room);
  };
  return row;
}

// What a row shows when it is opened is loaded when the first one is.
async function showDetail(row, room) {
  const { createDetail } = await import('./job_detail.js');
  if (!row.detail) room.append((row.detail = createDetail()).element);
  await row.detail.update(row.job);
}

// Columns that were chosen: their cells stand before the last one.
function showOthers(main, last, before, columns, job) {
  const cells = columns.map((column, i) => before[i] ?? h('td', { class: 'other', role: 'cell' }));
  for (const cell of before.slice(columns.length)) cell.remove();
  columns.forEach((column, i) => {
    cells[i].textContent = cellOf(column, job);
    cells[i].classList.toggle('number', column.isNumber);
    cells[i].dataset.title = headingOf(column);
    if (cells[i].nextSibling !== (cells[i + 1] ?? last)) main.insertBefore(cells[i], last);
  });
  return cells;
}

function showName(cell, job, open, actions) {
  const picture = pictureOf(job);
  replaceIfChanged(cell, [job.label, job.processID, picture, picture && job.status], () => h('div', { class: 'named' },
    picture ? thumbnail(job, picture) : null,
    h('div', null, h('button', { class: 'opener', 'aria-controls': `detail-${job.jobID}`, 'aria-expanded': 'false',
      onclick: () => actions.toggle(job.jobID) }, h('bdi', null, nameOf(job))),
    h('small', null, h('a', { href: pageOf(job) }, job.jobID)))));
  cell.querySelector('.opener').setAttribute('aria-expanded', String(open));
}

// What a job that waits or runs has to say, beyond that it does.
const USUAL = ['', 'waiting for a free worker', 'starting', 'growing', 'settling', 'rotating', 'filling', 'lifting', 'flowing'];
const isNews = job => CAN_BE_STOPPED.includes(job.status) && !USUAL.includes(job.message ?? '');

function showState(cell, job) {
  replaceIfChanged(cell, [job.status, job.attempt, job.message, job.position, job.expected_start], () => [
    h('span', { class: `badge ${job.status}` }, job.status),
    job.attempt > 1 ? h('small', { class: 'attempt' }, `attempt ${job.attempt}`) : null,
    job.status === 'running' ? h('progress', { max: 100, 'aria-label': 'progress' }) : null,
    job.status === 'running' ? h('small', { class: 'left' }) : null,
    job.position ? h('small', { class: 'place' }, `${count(job.position)}. in line${job.expected_start ? `, expected ${clock(job.expected_start)}` : ''}`) : null,
    isNews(job) ? h('small', { class: 'news', title: job.message }, job.message) : null,
    job.status === 'failed' && job.message ? h('small', { class: 'why', title: job.message }, job.message) : null]);
  const bar = cell.querySelector('progress');
  if (!bar) return;
  bar.value = job.progress ?? 0;
  const left = typeof job.eta_seconds === 'number' ? ` · ${duration(job.eta_seconds)} left` : '';
  cell.querySelector('.left').textContent = `${Math.floor(job.progress ?? 0)} %${left}`;
}

function showInputs(cell, job) {
  const words = inputsInWords(job);
  replaceIfChanged(cell, words, () => words.map(({ text, title }) => h('span', { title }, text)));
}

function showAnswer(cell, job) {
  const { angle_deg, fill_fraction, steady, verdict, minimum_omega2, warnings } = job.summary ?? {};
  const words = answerInWords(job);
  replaceIfChanged(cell, [words, fill_fraction, steady, verdict, warnings, job.status], () => {
    if (words === null) return nothing();
    const isRate = minimum_omega2 !== undefined;
    return [!pictureOf(job) && angle_deg !== undefined && fill_fraction !== undefined ? drumPicture({ angle_deg, fill_fraction }, 34) : null,
      h('span', { class: 'value', title: isRate ? 'least rate that keeps the particle on the wall' : 'angle of repose' }, words,
        isRate ? h('small', { class: 'quiet' }, `ω²R/g ${significant(minimum_omega2, 4)}`) : null,
        steady !== true && verdictInWords({ verdict, steady }) ? h('small', null, verdictInWords({ verdict, steady })) : null,
        warnings > 0 ? h('small', { class: 'why' }, warnings === 1 ? 'a warning' : `${count(warnings)} warnings`) : null)];
  });
}

function showRegime(cell, { regime, certain }) {
  replaceIfChanged(cell, [regime, certain], () => regime ? regimeInWords(regime, certain) : nothing());
}

function showTimes(cell, job) {
  const end = job.finished ?? (job.status === 'running' ? new Date().toISOString() : null);
  const took = secondsBetween(job.started, end);
  const line = (name, iso) => h('span', null, `${name} `, h('time', { datetime: iso, title: iso }, clock(iso)));
  replaceIfChanged(cell, [job.created, job.started, job.finished, job.status, Math.floor(took ?? -1)], () => [
    line('submitted', job.created),
    job.started ? line('started', job.started) : null,
    took !== null ? h('span', null, `${job.finished ? 'took' : 'running for'} ${duration(took)}`) : null]);
}

function showActions(cell, job, row, actions) {
  replaceIfChanged(cell, CAN_BE_STOPPED.includes(job.status), () => !CAN_BE_STOPPED.includes(job.status) ? null
    : h('button', { class: 'stop', 'aria-label': `Cancel ${nameOf(job)}`, onclick: () => actions.stop(row.job) }, 'Cancel'));
}

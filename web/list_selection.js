// The jobs that were picked, one by one or all that the filter lets through, and what can be done with them.
import { h } from './dom.js';
import { dismissJob, jobPath, json, request, root } from './api.js';
import { count } from './format.js';

const MOST_COMPARED = 6, MOST_ARCHIVES = 10;

export function createSelection(changed) {
  const ids = new Map(); // id: job
  let all = false;       // not these, but all of the filter
  return {
    has: id => all || ids.has(id),
    isAll: () => all,
    jobs: () => [...ids.values()],
    see: job => { if (ids.has(job.jobID)) ids.set(job.jobID, job); }, // as it is now
    set: (job, on) => { all = false; if (on) ids.set(job.jobID, job); else ids.delete(job.jobID); changed(); },
    setPage: (jobs, on) => { all = false; for (const job of jobs) if (on) ids.set(job.jobID, job); else ids.delete(job.jobID); changed(); },
    takeAll: () => { all = true; changed(); },
    clear: () => { all = false; ids.clear(); changed(); },
  };
}

// total: jobs that the filter lets through; filter: URLSearchParams; ask(question, yes): resolves to true; done(text).
export function selectionBar(selection, total, filter, ask, done) {
  const jobs = selection.jobs(), number = selection.isAll() ? total : jobs.length;
  if (number === 0) return [];
  const ids = jobs.map(job => job.jobID), what = number === 1 ? 'one job' : `${count(number)} jobs`;
  const button = (text, act, disabled = false) => h('button', { type: 'button', disabled, onclick: act }, text);
  return [
    h('strong', null, `${what} selected`),
    !selection.isAll() && total > number ? button(`Select all ${count(total)}`, selection.takeAll) : null,
    h('a', { class: 'button', href: `${root}web/compare.html?ids=${ids.join(',')}`, hidden: selection.isAll() || number < 2 || number > MOST_COMPARED }, 'Compare'),
    button('Cancel', async () => {
      if (await ask(`Cancel ${what}? Those that have ended stay as they are.`, 'Cancel them')) done(await changeAll(selection, filter, ids, 'cancel'));
    }),
    button('Delete', async () => {
      if (await ask(`Delete ${what} for good, with all files? Those that wait or run are left.`, 'Delete them')) done(await changeAll(selection, filter, ids, 'delete'));
    }),
    button('CSV', async () => saveTable(await tableOf(filter, selection.isAll() ? null : new Set(ids)))),
    button('Files (tar)', () => ids.forEach(id => follow(`${jobPath(id)}/files.tar`, `${id}.tar`)), selection.isAll() || number > MOST_ARCHIVES),
    button('Select none', selection.clear),
  ];
}

async function changeAll(selection, filter, ids, what) {
  if (selection.isAll()) {
    const query = new URLSearchParams(filter);
    if (query.size === 0) query.set('status', what === 'cancel' ? 'accepted,running' : 'successful,failed,dismissed');
    return (await json(`${root}jobs/${what}?${query}`, { method: 'POST' })).message;
  }
  let changed = 0;
  const waits = new Map(selection.jobs().map(job => [job.jobID, ['accepted', 'running'].includes(job.status)]));
  for (const id of ids.filter(one => waits.get(one) === (what === 'cancel'))) {
    try {
      await (what === 'cancel' ? dismissJob(id) : json(`${jobPath(id)}?only=delete`, { method: 'DELETE' }));
      changed++;
    } catch (error) {
      if (![404, 409].includes(error.status)) throw error;
    }
  }
  return `${count(changed)} of ${count(ids.length)} jobs ${what === 'cancel' ? 'cancelled' : 'deleted'}`;
}

// The daemon's table of the filter; of single jobs their lines alone. ids: null: all.
async function tableOf(filter, ids) {
  const query = new URLSearchParams(filter);
  query.set('f', 'csv');
  const text = await (await request(`${root}jobs?${query}`, { accept: 'text/csv' })).text();
  if (!ids) return text;
  const [head, ...lines] = text.split(/\r?\n/);
  return [head, ...lines.filter(line => ids.has(line.slice(0, line.indexOf(',')).replaceAll('"', '')))].join('\r\n');
}

function saveTable(text) {
  const address = URL.createObjectURL(new Blob([text], { type: 'text/csv' }));
  follow(address, 'jobs.csv');
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

function follow(href, name) {
  const link = h('a', { href, download: name });
  document.body.append(link);
  link.click();
  link.remove();
}

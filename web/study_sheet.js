// What all cases of a study share: the inputs as they were run, the program and the machine, told by one of its runs.
import { h } from './dom.js';
import { jobPath, json, root } from './api.js';
import { inputTables } from './input_table.js';
import { resultTables } from './result_table.js';

// {inputs} without those members that have these pointers.
function without(inputs, pointers) {
  const own = structuredClone(inputs);
  for (const pointer of pointers) {
    const parts = pointer.split('/'), last = parts.pop();
    const holder = parts.reduce((object, part) => object?.[part], own);
    if (holder) delete holder[last];
  }
  return own;
}

// box: what it goes into, once a run has ended well. varied: the inputs that cases differ in, as "contact/friction".
export async function showShared(box, id, varied, { inputs: described, schemas }) {
  if (box.childElementCount > 0) return;
  const { jobs } = await json(`${root}jobs?${new URLSearchParams({ study: id, status: 'successful', limit: 1 })}`);
  if (jobs.length === 0) return;
  const [spec, results] = await Promise.all(['spec', 'results'].map(what => json(`${jobPath(jobs[0].jobID)}/${what}`)));
  box.replaceChildren(h('h2', null, 'What all cases share'), inputTables(without(spec.inputs, [...varied, 'seed']), described),
    h('h2', null, 'Program and machine'), h('p', { class: 'quiet' }, 'As told by one of the runs, ', h('a', { href: `${root}web/job.html?id=${encodeURIComponent(jobs[0].jobID)}` }, jobs[0].jobID), '.'),
    resultTables({ run: results.run ?? {} }, schemas));
}

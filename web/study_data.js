// What is known of a study's cases and runs on this page. A large study comes in parts, one a poll, and only what may have
// changed is asked for again.
import { json, root, studyPath } from './api.js';

const PART = 100;        // cases of one answer
const MOST_RUNS = 400;   // single runs that a plot shows
const PAUSE_A_CASE = 40; // ms between two looks at a part, for each of its cases

export function createStudyData(id) {
  const cases = [], parts = new Map(); // first case: {updated, asked}
  let runs = [], runsOf = '';

  const isDone = first => cases.slice(first, first + PART).every(one => one.finished + one.failed >= one.repeats);
  // The first part that is not known as it is now; undefined: all are.
  function due(study) {
    const ended = study.status !== 'accepted' && study.status !== 'running';
    const firsts = Array.from({ length: Math.ceil(study.cases / PART) }, (_, k) => k * PART);
    const isDue = first => {
      const part = parts.get(first);
      if (!part) return true;
      if (part.updated === study.updated || (isDone(first) && !ended)) return false;
      return ended || Date.now() - part.asked >= PAUSE_A_CASE * Math.min(PART, study.cases);
    };
    return firsts.filter(isDue).sort((a, b) => (parts.get(a)?.asked ?? 0) - (parts.get(b)?.asked ?? 0))[0];
  }

  // Resolves to true when something is new.
  async function follow(study, columns) {
    const first = due(study);
    if (first === undefined) return false;
    const part = await json(`${studyPath(id)}/results?after=${first}&limit=${PART}`);
    part.cases.forEach((one, k) => { cases[first + k] = one; });
    parts.set(first, { updated: study.updated, asked: Date.now() });
    if (study.jobs <= MOST_RUNS && runsOf !== study.updated) {
      runs = await runsIn(columns);
      runsOf = study.updated;
    }
    return true;
  }

  async function runsIn(columns) {
    const names = ['id', 'study_case', 'regime', 'certain', 'omega2_inner', 'angle_deg', 'friction', ...columns].filter((name, i, all) => /^\w+$/.test(name) && all.indexOf(name) === i);
    const sql = `select ${names.join(', ')} from run_summary where study = '${id.replace(/[^0-9a-f-]/g, '')}' limit ${MOST_RUNS}`;
    const answer = await json(`${root}query?${new URLSearchParams({ sql })}`);
    return answer.rows.map(row => Object.fromEntries(answer.columns.map((name, i) => [name, row[i]])));
  }
  return { id, cases, follow, runs: () => runs, known: () => cases.filter(Boolean).length, isWhole: study => parts.size >= Math.ceil(study.cases / PART) };
}

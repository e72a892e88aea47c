// Where waiting jobs stand in line. The daemon counts that for one job at a time, so it is asked for the first few alone.
import { ApiError, jobPath, json } from './api.js';

const MOST = 8;       // jobs
const LASTS = 10_000; // ms until it is asked for again

const known = new Map(); // id: {position, expected_start, at}

// What is known already goes into the jobs at once.
export function knownPlaces(jobs) {
  const waits = new Set(jobs.filter(job => job.status === 'accepted').map(job => job.jobID));
  for (const id of known.keys()) if (!waits.has(id)) known.delete(id);
  for (const job of jobs) if (known.has(job.jobID)) Object.assign(job, known.get(job.jobID));
}

// Whether anything new is known.
export async function learnPlaces(jobs) {
  const now = performance.now();
  const due = jobs.filter(job => job.status === 'accepted').slice(0, MOST).filter(({ jobID }) => !(now - known.get(jobID)?.at < LASTS));
  await Promise.all(due.map(async ({ jobID }) => {
    try {
      const { position, expected_start } = await json(jobPath(jobID));
      known.set(jobID, { position, expected_start, at: now });
    } catch (error) {
      if (!(error instanceof ApiError)) throw error; // it is gone, or the next poll tells what is wrong
    }
  }));
  return due.length > 0;
}

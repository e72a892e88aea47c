// How the results of each process are shown, and whether it has anything over time to show.
import { answer, resultsInWords } from './results.js';
import { granuleAnswer, granuleInWords } from './granule_results.js';
import { fillAnswer, heapAnswer, standingInWords } from './standing_results.js';
import { flowAnswer, flowInWords } from './flow_results.js';

const VIEWS = {
  drum: { answer: (results, summary) => answer(results.repose ?? {}, results.regime, summary), results: resultsInWords, series: true },
  fill: { answer: fillAnswer, results: standingInWords, series: true },
  heap: { answer: heapAnswer, results: standingInWords, series: true },
  orifice: { answer: flowAnswer, results: flowInWords, series: true },
  granule: { answer: granuleAnswer, results: granuleInWords, series: false },
};

export const viewOf = process => VIEWS[process] ?? VIEWS.drum;

// Talking with the daemon: JSON in, JSON out, and every failure an error that says what happened.

import { filterOf } from './filter.js';

// Where the service is: a proxy may put it below a path of its own.
export const root = new URL('..', import.meta.url).pathname;

const SILENCE = 20_000; // ms without a byte: an answer may take as long as it likes, while it comes

// What the daemon answered, when it was not what we asked for. `status` 0: no answer at all; `problem`: the document, if there was one.
export class ApiError extends Error {
  constructor(status, message, problem = null) {
    super(message);
    this.status = status;
    this.problem = problem;
  }
}

// The token goes to the daemon once and is kept nowhere: a cookie that scripts can't read stands for it from then on.
export const session = {
  isAsked: () => sessionStorage.getItem('session') !== null, // whether this daemon wants a token
  begin: async token => {
    sessionStorage.setItem('session', 'asked');
    await request(`${root}session`, { method: 'POST', body: JSON.stringify({ token }) });
  },
};

// The daemon's tokens have no other characters.
export const canBeToken = text => /^[\x21-\x7e]+$/.test(text);

// cache: 'default' for what never changes.
export async function request(path, { method = 'GET', accept = 'application/json', body, cache = 'no-store' } = {}) {
  const headers = { Accept: accept };
  if (method !== 'GET') headers['Content-Type'] = 'application/json';
  const silence = new AbortController();
  let timer = 0, answer;
  const heard = () => {
    clearTimeout(timer);
    timer = setTimeout(() => silence.abort(), SILENCE);
  };
  try {
    heard();
    answer = await whole(await fetch(path, { method, headers, body, cache, signal: silence.signal }), heard);
  } catch {
    throw new ApiError(0, silence.signal.aborted ? `no answer for ${SILENCE / 1000} s` : 'no connection');
  } finally {
    clearTimeout(timer);
  }
  if (!answer.ok) throw await errorOf(answer);
  return answer;
}

// The same answer with all of its body. heard(): called for each piece.
async function whole(answer, heard) {
  heard();
  if (!answer.body) return answer;
  const pieces = [], reader = answer.body.getReader();
  for (let piece = await reader.read(); !piece.done; piece = await reader.read()) {
    heard();
    pieces.push(piece.value);
  }
  return new Response(new Blob(pieces), { status: answer.status, headers: answer.headers });
}

export const json = async (path, options) => (await request(path, options)).json();

async function errorOf(answer) {
  try {
    const problem = await answer.json();
    return new ApiError(answer.status, problem.detail || problem.title || `status ${answer.status}`, problem);
  } catch {
    return new ApiError(answer.status, `status ${answer.status}`);
  }
}

// view: of view.js; status: several with commas between them.
export function listJobs({ cursor, limit, sort, ...filter }) {
  const query = filterOf(filter);
  query.set('limit', limit);
  if (sort) query.set('sort', sort);
  if (cursor) query.set('cursor', cursor);
  return json(`${root}jobs?${query}`);
}

export const jobPath = id => `${root}jobs/${encodeURIComponent(id)}`;
export const dismissJob = id => json(`${jobPath(id)}?only=dismiss`, { method: 'DELETE' });

export const studyPath = id => `${root}studies/${encodeURIComponent(id)}`;
export const dismissStudy = id => json(`${studyPath(id)}?only=dismiss`, { method: 'DELETE' });

export const calibrationPath = id => `${root}calibrations/${encodeURIComponent(id)}`;
export const dismissCalibration = id => json(`${calibrationPath(id)}?only=dismiss`, { method: 'DELETE' });
export const retryCalibration = id => json(`${calibrationPath(id)}/retry`, { method: 'POST', body: '{}' });

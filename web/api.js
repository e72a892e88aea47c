// Talking with the daemon: JSON in, JSON out, and every failure an error that says what happened.

const TIMEOUT = 10_000; // ms

// What the daemon answered, when it was not what we asked for. `status` 0: no answer at all.
export class ApiError extends Error {
  constructor(status, message) {
    super(message);
    this.status = status;
  }
}

// Kept for this tab only: the token opens the daemon to whoever holds it.
export const token = {
  read: () => sessionStorage.getItem('token'),
  keep: value => sessionStorage.setItem('token', value),
};

export async function request(path, { method = 'GET', accept = 'application/json' } = {}) {
  const headers = { Accept: accept };
  if (token.read()) headers.Authorization = `Bearer ${token.read()}`;
  if (method !== 'GET') headers['Content-Type'] = 'application/json';
  let answer;
  try {
    answer = await fetch(path, { method, headers, cache: 'no-store', signal: AbortSignal.timeout(TIMEOUT) });
  } catch (error) {
    throw new ApiError(0, error.name === 'TimeoutError' ? 'no answer within 10 s' : 'no connection');
  }
  if (!answer.ok) throw new ApiError(answer.status, await reasonIn(answer));
  return answer;
}

export const json = async (path, options) => (await request(path, options)).json();

async function reasonIn(answer) {
  try {
    const problem = await answer.json();
    return problem.detail || problem.title || `status ${answer.status}`;
  } catch {
    return `status ${answer.status}`;
  }
}

export function listJobs({ status, q, study, cursor, limit }) {
  const query = new URLSearchParams({ limit });
  if (status) query.set('status', status);
  if (q) query.set('q', q);
  if (study) query.set('study', study);
  if (cursor) query.set('cursor', cursor);
  return json(`/jobs?${query}`);
}

export const jobPath = id => `/jobs/${encodeURIComponent(id)}`;
export const dismissJob = id => json(jobPath(id), { method: 'DELETE' });

export const studyPath = id => `/studies/${encodeURIComponent(id)}`;
export const dismissStudy = id => json(studyPath(id), { method: 'DELETE' });

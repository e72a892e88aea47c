// Calls every operation of the service by a client that is typed by its OpenAPI document, and prints "METHOD path status" of each.
// What the document does not have, or has otherwise, does not compile.
import createClient from 'openapi-fetch';
import type { paths } from './api.js';

const [url, done, running, snapshot] = process.argv.slice(2);
const { GET, POST, DELETE } = createClient<paths>({ baseUrl: url });
const inputs = { drum: { diameter: 0.04, length: 0.012, rotation_rate: 6 }, particles: [{ diameter: 0.004 }] };

async function say(what: string, call: Promise<{ response: Response }>): Promise<void> {
  console.log(`${what} ${(await call).response.status}`);
}

const text = { parseAs: 'text' } as const;
const id = { path: { id: done } };
await say('GET /', GET('/', { params: { query: { f: 'json' } } }));
await say('GET /web/{name}', GET('/web/{name}', { params: { path: { name: 'style.css' } }, ...text }));
await say('GET /conformance', GET('/conformance'));
await say('GET /api', GET('/api', { params: { query: { f: 'yaml', version: '3.1' } }, ...text }));
await say('GET /problems', GET('/problems'));
await say('GET /problems/{name}', GET('/problems/{name}', { params: { path: { name: 'not-found' } } }));
await say('POST /session', POST('/session', { body: { token: 'of a daemon that asks for none' } }));
await say('DELETE /session', DELETE('/session'));
await say('GET /healthz', GET('/healthz'));
await say('GET /readyz', GET('/readyz'));
await say('GET /metrics', GET('/metrics', text));
await say('GET /processes', GET('/processes', { params: { query: { limit: 2 } } }));
await say('GET /processes/{process}', GET('/processes/{process}', { params: { path: { process: 'drum' } } }));

const made = await POST('/processes/{process}/execution', {
  params: { path: { process: 'drum' }, header: { Prefer: 'respond-async' } },
  body: { process: 'drum', inputs, label: { by: 'a typed client' }, response: 'document', outputs: { repose: { transmissionMode: 'value' } } },
});
console.log(`POST /processes/{process}/execution ${made.response.status}`);
const job = await GET('/jobs/{id}', { params: { ...id, query: { wait: 1 } } });
console.log(`GET /jobs/{id} ${job.response.status}`);
const progress: number | undefined = job.data?.progress;
if (progress !== 100) throw new Error(`the job has come to ${progress} %`);
await say('GET /jobs', GET('/jobs', { params: { query: { status: ['failed', 'successful'], limit: 2 } }, querySerializer: { array: { style: 'form', explode: false } } }));
const results = await GET('/jobs/{id}/results', { params: id });
console.log(`GET /jobs/{id}/results ${results.response.status}`);
await say('GET /jobs/{id}/results/{output}', GET('/jobs/{id}/results/{output}', { params: { path: { id: done, output: 'repose' } } }));
await say('GET /jobs/{id}/spec', GET('/jobs/{id}/spec', { params: id }));
await say('GET /jobs/{id}/log', GET('/jobs/{id}/log', { params: id, ...text }));
await say('GET /jobs/{id}/samples', GET('/jobs/{id}/samples', { params: { ...id, query: { after: 1, f: 'json' } } }));
await say('GET /jobs/{id}/snapshots', GET('/jobs/{id}/snapshots', { params: id }));
await say('GET /jobs/{id}/snapshots/{file}', GET('/jobs/{id}/snapshots/{file}', { params: { path: { id: done, file: snapshot } }, ...text }));
await say('GET /jobs/{id}/fields.hdf', GET('/jobs/{id}/fields.hdf', { params: id, ...text }));
await say('GET /jobs/{id}/walls.vtp', GET('/jobs/{id}/walls.vtp', { params: id, ...text }));
await say('GET /jobs/{id}/snapshots.hdf.series', GET('/jobs/{id}/snapshots.hdf.series', { params: id }));
await say('GET /jobs/{id}/files.tar', GET('/jobs/{id}/files.tar', { params: id, ...text }));
await say('POST /jobs/{id}/pin', POST('/jobs/{id}/pin', { params: id }));
await say('POST /jobs/{id}/unpin', POST('/jobs/{id}/unpin', { params: id }));
await say('DELETE /jobs/{id}', DELETE('/jobs/{id}', { params: { path: { id: running }, query: { only: 'dismiss' } } }));
await say('POST /jobs/{id}/retry', POST('/jobs/{id}/retry', { params: { path: { id: running } } }));
await say('POST /jobs/{id}/continue', POST('/jobs/{id}/continue', { params: id, body: { revolutions: 1 } }));
await say('GET /query', GET('/query', { params: { query: { sql: 'select count(*) from job', f: 'json' } } }));

const study = await POST('/studies', { body: { name: 'typed', base: { inputs }, vary: { '/inputs/contact/friction': [0.1, 0.2] } } });
console.log(`POST /studies ${study.response.status}`);
const its = { path: { id: study.data?.studyID ?? '' } };
await say('GET /studies', GET('/studies', { params: { query: { limit: 1 } } }));
await say('GET /studies/{id}', GET('/studies/{id}', { params: { ...its, query: { wait: 10 } } }));
await say('GET /studies/{id}/results', GET('/studies/{id}/results', { params: its }));
await say('GET /studies/{id}/results.csv', GET('/studies/{id}/results.csv', { params: its, ...text }));
await say('GET /studies/{id}/spec', GET('/studies/{id}/spec', { params: its }));
await say('POST /studies/{id}/retry', POST('/studies/{id}/retry', { params: its }));
await say('DELETE /studies/{id}', DELETE('/studies/{id}', { params: its }));

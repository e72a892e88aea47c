// What a job is called: what its label says, or its test.
export function nameOf(job) {
  const words = Object.values(job.label ?? {}).map(String).filter(Boolean);
  return words.length ? words.join(' · ') : `${job.processID} test`;
}

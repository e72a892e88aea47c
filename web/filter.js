// Which jobs are meant, as GET /jobs and its companions take it.
export function filterOf({ status, processID, q, study, datetime, labels = [], values = [] }) {
  const query = new URLSearchParams();
  for (const [name, value] of Object.entries({ status, processID, q, study, datetime })) if (value) query.set(name, value);
  for (const [name, value] of labels) query.set(`label.${name}`, value);
  for (const [name, value] of values) query.set(`value.${name}`, value);
  return query;
}

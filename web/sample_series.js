// What a run measured over time, column by column, as the curve draws it: thinned by the daemon, so that a long run costs no more
// than a short one, and of those columns alone that are looked at.
import { ApiError, jobPath, json } from './api.js';

const DEFINITIONS = { angle_deg: 'the angle', center_of_mass_deg: 'center-of-mass', theil_sen_deg: 'theil-sen', upper_chord_deg: 'upper-chord',
  lower_chord_deg: 'lower-chord', chord_deg: 'chord', apex_to_base_deg: 'apex-to-base', equal_volume_cone_deg: 'equal-volume-cone', silhouette_deg: 'silhouette' };
const POINTS = 1200; // of one answer; a curve is narrower than their half in pixels
const MOST = 4 * POINTS; // kept while a run grows, before all is thinned anew

// always: columns that are wanted whatever is drawn.
export function createSeries(id, always = []) {
  const series = { times: [], columns: new Map(), of: 0 };
  const path = `${jobPath(id)}/samples`;
  const known = new Set(), filled = new Set(); // columns that there are, and those of them that have values
  let last = -1, asked = '', chosen = [], going = Promise.resolve();

  const samplesOf = query => json(`${path}?${new URLSearchParams(query)}`);

  // Learns which columns there are, from those samples that have their least and largest values; of more samples than the daemon
  // thins at once in all columns, from the first.
  async function look() {
    const { of = 1, samples } = await samplesOf({ points: 2, after: last }).catch(error => {
      if (!(error instanceof ApiError) || error.status !== 400) throw error;
      return samplesOf({ limit: 1, after: last });
    });
    for (const { values } of samples)
      for (const [name, value] of Object.entries(values)) {
        known.add(name);
        if (value !== null) filled.add(name);
      }
    return of;
  }

  function forget(columns) {
    asked = String(columns);
    last = -1;
    Object.assign(series, { times: [], of: 0, columns: new Map(columns.map(name => [name, []])) });
  }

  function take({ of, samples }) {
    series.of += of;
    for (const { number, time, values } of samples) {
      last = number;
      series.times.push(time);
      for (const [name, list] of series.columns) list.push(values[name] ?? null);
    }
  }

  async function update() {
    const news = await look();
    const columns = [...new Set([...always, ...chosen])].filter(name => known.has(name)).sort();
    if (columns.length === 0) columns.push(...series.names().slice(0, 1));
    if (columns.length === 0) return;
    if (String(columns) !== asked || series.times.length > MOST) forget(columns);
    else if (news === 0) return;
    take(await samplesOf({ columns: columns.join(','), points: POINTS, after: last }));
  }

  // Learns of the samples taken since it last asked, and of columns that it did not have yet; one call after the other.
  series.update = () => (going = going.catch(() => {}).then(update));
  // Which columns are drawn, from now on. Whether one of them is still to be asked for.
  series.choose = names => {
    chosen = names;
    return names.some(name => filled.has(name) && !series.columns.has(name));
  };
  series.has = name => filled.has(name);
  series.names = () => [...known].filter(series.has);
  // The value of a column at the sample that is nearest in time; null where there is none.
  series.at = (name, time) => {
    const list = series.columns.get(name);
    if (!list?.length) return null;
    const next = series.times.findIndex(t => t >= time), k = next < 0 ? list.length - 1 : next;
    return list[k > 0 && time - series.times[k - 1] < series.times[k] - time ? k - 1 : k];
  };
  // [{key, name}] of the angles, and of all else that was measured.
  series.definitions = () => series.names().filter(key => DEFINITIONS[key]).map(key => ({ key, name: DEFINITIONS[key] }));
  series.others = () => series.names().filter(key => !DEFINITIONS[key]).map(key => ({ key, name: key.replaceAll('_', ' ') }));
  return series;
}

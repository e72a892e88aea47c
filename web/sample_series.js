// What a run measured over time, column by column, as the curve draws it.
import { jobPath, json } from './api.js';

const DEFINITIONS = { angle_deg: 'the angle', center_of_mass_deg: 'center-of-mass', theil_sen_deg: 'theil-sen', upper_chord_deg: 'upper-chord',
  lower_chord_deg: 'lower-chord', chord_deg: 'chord', apex_to_base_deg: 'apex-to-base', equal_volume_cone_deg: 'equal-volume-cone', silhouette_deg: 'silhouette' };

export function createSeries(id) {
  const series = { times: [], columns: new Map(), last: -1 };

  // Samples never change, so each is asked for once; an answer holds some thousands and links to the next.
  series.update = async () => {
    for (let more = true; more;) {
      const { samples, links } = await json(`${jobPath(id)}/samples?after=${series.last}`);
      for (const { number, time, values } of samples) {
        series.last = number;
        series.times.push(time);
        for (const [name, value] of Object.entries(values)) {
          if (name === 'time') continue;
          if (!series.columns.has(name)) series.columns.set(name, []);
          series.columns.get(name).push(value);
        }
      }
      more = links.some(link => link.rel === 'next');
    }
  };
  series.has = name => (series.columns.get(name) ?? []).some(value => value !== null);
  // The value of a column at the sample that is nearest in time; null where there is none.
  series.at = (name, time) => {
    const list = series.columns.get(name);
    if (!list?.length) return null;
    const next = series.times.findIndex(t => t >= time), k = next < 0 ? list.length - 1 : next;
    return list[k > 0 && time - series.times[k - 1] < series.times[k] - time ? k - 1 : k];
  };
  // [{key, name}] of the angles, and of all else that was measured.
  series.definitions = () => [...series.columns.keys()].filter(key => DEFINITIONS[key] && series.has(key)).map(key => ({ key, name: DEFINITIONS[key] }));
  series.others = () => [...series.columns.keys()].filter(key => !DEFINITIONS[key] && series.has(key)).map(key => ({ key, name: key.replaceAll('_', ' ') }));
  return series;
}

// Numbers, times and inputs as the page writes them. SI comes in; people read mm, rpm and minutes.

const missing = value => value === null || value === undefined || Number.isNaN(value);

export function significant(value, digits = 3) {
  if (missing(value)) return '–';
  if (value !== 0 && (Math.abs(value) >= 1e6 || Math.abs(value) < 1e-3)) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split('e');
    return `${Number(mantissa)}·10${superscript(Number(exponent))}`;
  }
  return Number(value.toPrecision(digits)).toLocaleString('en', { maximumSignificantDigits: digits });
}

export function superscript(integer) {
  const glyphs = { '-': '⁻', 0: '⁰', 1: '¹', 2: '²', 3: '³', 4: '⁴', 5: '⁵', 6: '⁶', 7: '⁷', 8: '⁸', 9: '⁹' };
  return [...String(integer)].map(character => glyphs[character]).join('');
}

export const count = value => missing(value) ? '–' : Math.round(value).toLocaleString('en');
export const percent = share => missing(share) ? '–' : `${significant(100 * share)} %`;

export function degrees(value, error) {
  if (missing(value)) return '–';
  // Two digits of the error, and never more than thousandths of a degree.
  const decimals = !(error > 0) ? 1 : Math.min(Math.max(1 - Math.floor(Math.log10(Number(error.toPrecision(2)))), 0), 3);
  const mean = value.toFixed(decimals);
  return missing(error) ? `${mean}°` : `${mean} ± ${error.toFixed(decimals)}°`;
}

export function millimetres(metres) {
  if (missing(metres)) return '–';
  return metres >= 1 ? `${significant(metres)} m` : `${significant(1000 * metres)} mm`;
}

export function duration(seconds) {
  if (missing(seconds) || seconds < 0) return '–';
  if (seconds > 0 && seconds < 0.95) return `${significant(seconds, 2)} s`;
  if (seconds < 10) return `${seconds.toFixed(1)} s`;
  if (seconds < 100) return `${Math.round(seconds)} s`;
  const minutes = Math.round(seconds / 60);
  if (minutes < 100) return `${minutes} min`;
  const hours = Math.floor(minutes / 60);
  if (hours < 48) return `${hours} h ${minutes % 60} min`;
  return `${Math.floor(hours / 24)} d ${hours % 24} h`;
}

export const secondsBetween = (from, to) => from && to ? (new Date(to) - new Date(from)) / 1000 : null;

// Today: the time of day. Another day: with the date.
export function clock(iso) {
  const when = new Date(iso);
  const time = when.toLocaleTimeString('en-GB');
  if (when.toDateString() === new Date().toDateString()) return time;
  const day = when.toLocaleDateString('en-GB', { day: 'numeric', month: 'short', year: 'numeric' });
  return `${day}, ${time.slice(0, 5)}`;
}

// What is thought of an angle, by its verdict; runs from before it was given say only whether they are steady.
export const VERDICTS = {
  steady: 'steady', drifting: 'not steady', 'too-short': 'too short to tell', 'too-few': 'too few particles to tell',
};
// Of several runs: "steady 2, too-short 1".
export const verdictsInWords = text => text.split(', ').map(one => {
  const [verdict, ...runs] = one.split(' ');
  return [VERDICTS[verdict] ?? verdict, ...runs].join(' ');
}).join(', ');

export const regimeInWords = (regime, certain) => certain === false ? `${regime}, not certain` : regime;

export function verdictInWords({ verdict, steady }) {
  return VERDICTS[verdict] ?? (steady === false ? 'not steady' : steady === true ? 'steady' : '');
}

export const NO_ANGLE = 'no angle';

// The answer of a job in one word: null while there is none.
export function answerInWords({ status, processID, summary }) {
  if (!missing(summary?.angle_deg)) return degrees(summary.angle_deg, summary.standard_error_deg);
  if (!missing(summary?.minimum_rotation_rate)) return `≥ ${significant(summary.minimum_rotation_rate, 4)} rad/s`;
  return status === 'successful' && processID !== 'granule' ? NO_ANGLE : null;
}

export function bytes(value) {
  if (missing(value)) return '–';
  const units = ['B', 'kB', 'MB', 'GB', 'TB'];
  let unit = 0;
  while (value >= 1000 && unit < units.length - 1) { value /= 1000; unit++; }
  return `${significant(value)} ${units[unit]}`;
}

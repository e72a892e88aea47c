// What a test would look like, to scale, while its numbers are being typed: container, bed, and one particle.
import { svg } from './dom.js';
import { millimetres, significant } from './format.js';
import { surfaceHeight } from './drum_picture.js';

const WIDE = 300, HIGH = 190, SOLID = 0.6; // SOLID: the share of a bed that is particles
const number = value => typeof value === 'number' && Number.isFinite(value) && value > 0 ? value : null;
const rect = (x, y, width, height, kind) => svg('rect', { x, y, width, height, class: kind });
const line = (x1, y1, x2, y2, kind = 'shell') => svg('line', { x1, y1, x2, y2, class: kind });
const text = (x, y, words, anchor = 'middle') => svg('text', { x, y, 'text-anchor': anchor }, words);

const particleOf = ({ particles }) => number(particles?.[0]?.diameter);
const volumeOf = (inputs, d) => d && number(inputs.particle_count) ? inputs.particle_count * Math.PI / 6 * d ** 3 / SOLID : null;

function arrow(x1, y1, x2, y2) {
  const [dx, dy] = [(x2 - x1) / Math.hypot(x2 - x1, y2 - y1), (y2 - y1) / Math.hypot(x2 - x1, y2 - y1)];
  return svg('path', { class: 'arrow', d: `M${x1} ${y1}L${x2} ${y2}M${x2 - 6 * dx + 4 * dy} ${y2 - 6 * dy - 4 * dx}L${x2} ${y2}L${x2 - 6 * dx - 4 * dy} ${y2 - 6 * dy + 4 * dx}` });
}

function drum(inputs) {
  const D = number(inputs.drum?.diameter), L = number(inputs.drum?.length), d = particleOf(inputs);
  if (!D) return null;
  const r = 70, cx = 84, cy = 92, scale = r / (D / 2);
  const volume = volumeOf(inputs, d);
  const fill = Math.min(Math.max(volume && L ? volume / (Math.PI * D * D / 4 * L) : number(inputs.fill_fraction) ?? 0.5, 0.005), 0.995);
  const c = surfaceHeight(fill), s = Math.sqrt(1 - c * c);
  const level = cy - r * c;
  const bed = `M${cx - r * s} ${level}A${r} ${r} 0 ${fill > 0.5 ? 1 : 0} 0 ${cx + r * s} ${level}Z`;
  const { count = 0, height = 0, width = 0 } = inputs.drum.lifters ?? {};
  const bars = Array.from({ length: Math.min(count, 64) }, (_, i) => svg('rect', { class: 'lifter', x: cx - width * scale / 2, y: cy + r - height * scale,
    width: width * scale, height: height * scale, transform: `rotate(${360 * i / count} ${cx} ${cy})` }));
  const long = L ? Math.min(L * scale, 110) : 0, left = 174, isCut = L && L * scale > 110;
  const ends = inputs.drum.ends === 'walls' ? 'shell' : 'dashed';
  const turns = Math.sign(inputs.drum.rotation_rate ?? inputs.drum.rotation_rate_rpm ?? 1);
  return [svg('circle', { cx, cy, r, class: 'inside' }), svg('path', { d: bed, class: 'bed' }), bars,
    svg('circle', { cx, cy, r, class: 'shell' }), d ? svg('circle', { cx, cy: cy + r - d * scale / 2, r: Math.max(d * scale / 2, 0.7), class: 'grain' }) : null,
    turns < 0 ? arrow(cx - 26, 15, cx + 26, 15) : arrow(cx + 26, 15, cx - 26, 15),
    text(cx, 181, `Ø ${millimetres(D)}${d ? `, ${significant(D / d)} particles` : ''}`),
    L ? [rect(left, cy - r, long, 2 * r, 'inside'), rect(left, level, long, cy + r - level, 'bed'), line(left, cy - r, left + long, cy - r), line(left, cy + r, left + long, cy + r),
      line(left, cy - r, left, cy + r, ends), line(left + long, cy - r, left + long, cy + r, isCut ? 'dashed' : ends),
      text(left + Math.max(long, 60) / 2, 181, `${millimetres(L)}${d ? `, ${significant(L / d)}` : ''}`)] : null];
}

// A standing vessel: wide, high (both m), filled up to `level` (m).
function vessel(wide, high, level, floor, words) {
  const scale = Math.min(150 / high, 160 / wide), w = wide * scale, x = (WIDE - w) / 2, bottom = floor;
  return { scale, x, w, parts: [rect(x, bottom - high * scale, w, high * scale, 'inside'), rect(x, bottom - Math.min(level, high) * scale, w, Math.min(level, high) * scale, 'bed'),
    line(x, bottom - high * scale, x, bottom), line(x + w, bottom - high * scale, x + w, bottom), text(WIDE / 2, 184, words)] };
}

const depthOf = (inputs, area, d) => volumeOf(inputs, d) ? volumeOf(inputs, d) / area : number(inputs.fill_height);

function heap(inputs) {
  const D = number(inputs.tube?.diameter), d = particleOf(inputs);
  if (!D) return null;
  const level = depthOf(inputs, Math.PI * D * D / 4, d) ?? 2 * D, P = number(inputs.plate?.diameter) ?? 3 * D;
  const scale = Math.min(140 / level, 270 / Math.max(P, D)), floor = 166, w = D * scale, x = (WIDE - w) / 2;
  return [rect(x, floor - level * scale, w, level * scale, 'bed'), line(x, 12, x, floor), line(x + w, 12, x + w, floor),
    line((WIDE - P * scale) / 2, floor, (WIDE + P * scale) / 2, floor), arrow(x + w + 14, 70, x + w + 14, 30),
    d ? svg('circle', { cx: x + d * scale / 2, cy: floor - d * scale / 2, r: Math.max(d * scale / 2, 0.7), class: 'grain' }) : null,
    text(WIDE / 2, 184, `tube Ø ${millimetres(D)} on a plate of ${millimetres(P)}`)];
}

function fill(inputs) {
  const D = number(inputs.cylinder?.diameter), d = particleOf(inputs);
  if (!D) return null;
  const level = depthOf(inputs, Math.PI * D * D / 4, d) ?? D / 2, high = number(inputs.cylinder.height) ?? Math.max(1.5 * level, D);
  const { scale, parts } = vessel(D, high, level, 168, `cylinder Ø ${millimetres(D)}`);
  const stream = (number(inputs.stream?.diameter) ?? D / 4) * scale;
  return [...parts, line(WIDE / 2 - D * scale / 2, 168, WIDE / 2 + D * scale / 2, 168),
    rect((WIDE - stream) / 2, 6, stream, Math.max(168 - level * scale - 6, 0), 'stream'), arrow(WIDE / 2, 8, WIDE / 2, 30)];
}

function orifice(inputs) {
  const D = number(inputs.vessel?.diameter) ?? number(inputs.vessel?.width), d = particleOf(inputs);
  if (!D) return null;
  const area = number(inputs.vessel?.diameter) ? Math.PI * D * D / 4 : D * (number(inputs.vessel?.depth) ?? D);
  const level = depthOf(inputs, area, d) ?? 2 * D, high = Math.max(1.15 * level, D);
  const hole = number(inputs.orifice?.diameter) ?? number(inputs.orifice?.width) ?? 0, half = number(inputs.hopper?.half_angle_deg);
  const { scale, x, w, parts } = vessel(D, high, level, 152, `${millimetres(D)} wide, orifice ${hole ? millimetres(hole) : '–'}${d && hole ? `, ${significant(hole / d)} particles` : ''}`);
  const left = (WIDE - hole * scale) / 2, drop = half ? Math.min((D - hole) / 2 / Math.tan(half * Math.PI / 180) * scale, 60) : 0;
  return [...parts, drop ? svg('path', { class: 'cover', d: `M${x} 152L${x} ${152 - drop}L${left} 152ZM${x + w} 152L${x + w} ${152 - drop}L${WIDE - left} 152Z` }) : null,
    line(x, 152 - drop, left, 152), line(WIDE - left, 152, x + w, 152 - drop), hole ? arrow(WIDE / 2, 154, WIDE / 2, 170) : null];
}

function granule(inputs) {
  const R = number(inputs.radius) ?? 0.063;
  return [svg('circle', { cx: 150, cy: 90, r: 72, class: 'inside' }), svg('circle', { cx: 150, cy: 90, r: 72, class: 'shell' }),
    svg('circle', { cx: 150 + 72 * Math.sin(0.6) * 0.93, cy: 90 + 72 * Math.cos(0.6) * 0.93, r: 5, class: 'grain' }), arrow(176, 14, 124, 14),
    text(150, 184, `R ${millimetres(R)}`)];
}

const DRAWINGS = { drum, heap, fill, orifice, granule };

// null: nothing is known of its shape yet.
export function outlineOf(process, inputs) {
  const parts = DRAWINGS[process]?.(inputs);
  return parts && svg('svg', { class: 'outline', viewBox: `0 0 ${WIDE} ${HIGH}`, role: 'img', 'aria-label': 'outline of the test, to scale' }, parts.flat(2));
}

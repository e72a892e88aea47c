// What is drawn over a bed: glued spheres of a lining, the line at the surface's angle, the way of gravity, a bar of known length.
import { dot, onCanvas } from './bed_camera.js';
import { surfaceHeight } from './drum_picture.js';
import { degrees, millimetres } from './format.js';

export function drawMarks(context, scene, state, view, colors, ratio) {
  const isDrum = scene.process === 'drum';
  context.lineCap = 'round';
  context.font = `${12.5 * ratio}px ${getComputedStyle(document.body).fontFamily}`;
  if (isDrum) drawLining(context, scene, state.frame, view, colors);
  if (typeof state.angle === 'number' && isDrum) drawSurface(context, scene, state, view, colors, ratio);
  drawGravity(context, scene, view, colors, ratio);
  drawScale(context, view, colors, ratio);
}

// Glued spheres, as many around the wall as their pitch leaves room for, turned with it.
function drawLining(context, scene, frame, view, colors) {
  const lining = scene.inputs.wall?.lining;
  if (!lining) return;
  const at = scene.inputs.drum.diameter / 2, around = Math.floor(2 * Math.PI * at / lining.pitch + 1e-9);
  context.fillStyle = colors.quiet;
  for (let k = 0; k < around; k++) {
    const turned = (frame?.angle ?? 0) + 2 * Math.PI * k / around;
    const [x, y] = onCanvas(view, [at * Math.cos(turned), at * Math.sin(turned), view.center[2]]);
    context.beginPath();
    context.arc(x, y, lining.diameter / 2 * view.unit, 0, 2 * Math.PI);
    context.fill();
  }
}

// The line at the angle of the moment, where a level surface of as full a drum would be.
function drawSurface(context, scene, state, view, colors, ratio) {
  const { drum, fill_fraction: fraction } = scene.inputs;
  const radius = drum.diameter / 2, phi = state.angle * Math.PI / 180 * (drum.rotation_rate < 0 ? -1 : 1);
  const c = surfaceHeight(Math.min(Math.max(fraction ?? 0.5, 0.02), 0.98)), half = Math.sqrt(1 - c * c);
  const z = view.center[2] + (state.cut >= 1 ? 0.5 : state.cut - 0.5) * drum.length;
  const point = along => [radius * (along * Math.cos(phi) - c * Math.sin(phi)), radius * (along * Math.sin(phi) + c * Math.cos(phi)), z];
  const [a, b] = [onCanvas(view, point(-half)), onCanvas(view, point(half))];
  for (const [color, width] of [[colors.sheet, 4.5], [colors.run, 2]]) {
    context.strokeStyle = color;
    context.lineWidth = width * ratio;
    context.beginPath();
    context.moveTo(...a);
    context.lineTo(...b);
    context.stroke();
  }
  const words = degrees(state.angle), wide = context.measureText(words).width + 12 * ratio, [x, y] = a;
  const left = Math.min(Math.max(x - wide - 6 * ratio, 6 * ratio), view.width - wide - 6 * ratio), top = Math.max(y - 26 * ratio, 4 * ratio);
  context.fillStyle = colors.run;
  context.beginPath();
  context.roundRect(left, top, wide, 20 * ratio, 5 * ratio);
  context.fill();
  context.fillStyle = colors.sheet;
  context.fillText(words, left + 6 * ratio, top + 14.5 * ratio);
}

function drawGravity(context, scene, view, colors, ratio) {
  const tilt = (scene.inputs.drum?.tilt_deg ?? 0) * Math.PI / 180;
  const way = scene.process === 'drum' ? [0, -Math.cos(tilt), -Math.sin(tilt)] : [0, 0, -1];
  const [dx, dy] = [dot(view.toView[0], way), -dot(view.toView[1], way)];
  const size = 30 * ratio, x = view.width - 24 * ratio, y = view.height - 48 * ratio;
  const [tipX, tipY] = [x + dx * size, y + dy * size];
  context.strokeStyle = context.fillStyle = colors.quiet;
  context.lineWidth = 1.6 * ratio;
  context.beginPath();
  context.moveTo(x, y);
  context.lineTo(tipX, tipY);
  context.stroke();
  context.beginPath();
  context.moveTo(tipX + 5 * ratio * dx, tipY + 5 * ratio * dy);
  context.lineTo(tipX - 4 * ratio * dy, tipY + 4 * ratio * dx);
  context.lineTo(tipX + 4 * ratio * dy, tipY - 4 * ratio * dx);
  context.fill();
  context.fillText('g', x - 14 * ratio, y + 6 * ratio);
}

function drawScale(context, view, colors, ratio) {
  const wanted = view.width / 5 / view.unit, power = 10 ** Math.floor(Math.log10(wanted));
  const length = [5, 2, 1].map(m => m * power).find(l => l <= wanted);
  const [x, y, end] = [14 * ratio, view.height - 16 * ratio, 14 * ratio + length * view.unit];
  context.strokeStyle = context.fillStyle = colors.quiet;
  context.lineWidth = 1.6 * ratio;
  context.beginPath();
  context.moveTo(x, y - 4 * ratio);
  context.lineTo(x, y);
  context.lineTo(end, y);
  context.lineTo(end, y - 4 * ratio);
  context.stroke();
  context.fillText(millimetres(length), x + 4 * ratio, y - 7 * ratio);
}

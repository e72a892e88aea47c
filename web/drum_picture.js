// The drum seen along its axis: a circle and the bed in it, its surface at the measured angle. The drum
// turns counter-clockwise, so the surface rises to the right.
import { svg } from './dom.js';

// Height of a level surface above the centre of a unit circle, for the share of its area that lies below.
export function surfaceHeight(fraction) {
  const shareBelow = c => 1 - (Math.acos(c) - c * Math.sqrt(1 - c * c)) / Math.PI;
  let low = -1, high = 1;
  for (let i = 0; i < 40; i++) {
    const middle = (low + high) / 2;
    if (shareBelow(middle) < fraction) low = middle; else high = middle;
  }
  return (low + high) / 2;
}

export function drumPicture({ angle_deg, fill_fraction }, size, description) {
  const fraction = Math.min(Math.max(fill_fraction ?? 0.5, 0.01), 0.99);
  const phi = (angle_deg ?? 0) * Math.PI / 180;
  const c = surfaceHeight(fraction), s = Math.sqrt(1 - c * c);
  const [tx, ty] = [Math.cos(phi), -Math.sin(phi)];   // along the surface; y points down in SVG
  const [nx, ny] = [-Math.sin(phi), -Math.cos(phi)];  // out of the bed
  const point = side => `${(c * nx + side * s * tx).toFixed(4)} ${(c * ny + side * s * ty).toFixed(4)}`;
  const bed = `M${point(-1)}A1 1 0 ${fraction > 0.5 ? 1 : 0} 0 ${point(1)}Z`;
  const known = angle_deg !== null && angle_deg !== undefined;
  return svg('svg', {
    class: known ? 'drum' : 'drum unknown', width: size, height: size, viewBox: '-1.1 -1.1 2.2 2.2',
    ...(description ? { role: 'img', 'aria-label': description } : { 'aria-hidden': 'true' }),
  },
  svg('circle', { class: 'inside', r: 1 }),
  svg('path', { class: 'bed', d: bed }),
  svg('circle', { class: 'shell', r: 1 }));
}

// From where a bed is seen: what is right, up and near, and where on the canvas a place in the container is.
const MARGIN = 1.13;   // of the picture around what is in it

// right, up, and towards the viewer, before the user turns anything: along the axis of a drum, from the side of what stands.
const BASES = { drum: [[1, 0, 0], [0, 1, 0], [0, 0, 1]], upright: [[1, 0, 0], [0, 0, 1], [0, -1, 0]] };

export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const mixed = (a, b, c, s) => a.map((x, k) => x * c + b[k] * s);

function extentOf(scene, { walls, frame }) {
  const isDrum = scene.process === 'drum';
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  const add = p => p.forEach((x, k) => { low[k] = Math.min(low[k], x); high[k] = Math.max(high[k], x); });
  if (walls) walls.points.forEach(add);
  else if (frame) { add(frame.low); add(frame.high); }
  if (!walls && isDrum) { const r = scene.inputs.drum.diameter / 2; add([-r, -r, 0]); add([r, r, 0]); }
  return { low, high };
}

// Where the viewer stands, for a canvas of this many pixels: unit is how many of them a metre has.
export function cameraOf(scene, state, width, height) {
  const isDrum = scene.process === 'drum', { low, high } = extentOf(scene, state);
  const center = low.map((x, k) => (x + high[k]) / 2);
  const [right, up, near] = BASES[isDrum ? 'drum' : 'upright'];
  const [cy, sy, cp, sp] = [Math.cos(state.yaw), Math.sin(state.yaw), Math.cos(state.pitch), Math.sin(state.pitch)];
  const side = mixed(right, near, cy, -sy), front = mixed(near, right, cy, sy);
  const toView = [side, mixed(up, front, cp, -sp), mixed(front, up, cp, sp)];
  const reach = axis => 0.5 * high.reduce((sum, x, k) => sum + Math.abs(axis[k]) * (x - low[k]), 0);
  // a round thing reaches as far in all directions: no change of size while it is turned
  const across = isDrum ? Math.hypot(scene.inputs.drum.diameter / 2, (state.yaw || state.pitch) ? (high[2] - low[2]) / 2 : 0) : null;
  const unit = state.zoom / MARGIN * Math.min(width / 2 / (across ?? reach(toView[0])), height / 2 / (across ?? reach(toView[1])));
  const whole = Math.hypot(...high.map((x, k) => x - low[k])) / 2 || 1;
  const depth = 0.5 * (dot(high, near.map(Math.abs)) - dot(low, near.map(Math.abs)));
  return {
    center, toView, scale: [2 * unit / width, 2 * unit / height, 1 / (1.2 * whole)], pan: state.pan, unit, depthAxis: near,
    cut: state.cut >= 1 ? 1e9 : depth * (2 * state.cut - 1), width, height,
  };
}

export const onCanvas = (view, world) => {
  const c = world.map((x, k) => x - view.center[k]);
  return [view.width / 2 * (1 + view.pan[0] + dot(view.toView[0], c) * view.scale[0]),
    view.height / 2 * (1 - view.pan[1] - dot(view.toView[1], c) * view.scale[1])];
};

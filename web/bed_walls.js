// The walls of a run as it writes them for ParaView (walls.vtp): the edges to be drawn as lines, and what lies flat as faces.
const SHELL = 0, END = 1, LIFTER = 2, PLATE = 3;
const EVERY = 8;          // of the strips of a round shell, those whose edge shows how far it has turned
const SHARP = 0.9;        // cosine between two faces, below which their common edge is drawn

export function parseWalls(text) {
  const document = new DOMParser().parseFromString(text, 'application/xml');
  const numbers = name => (document.querySelector(`DataArray[Name="${name}"]`)?.textContent ?? '').trim().split(/\s+/).map(Number);
  const flat = numbers('Points'), parts = numbers('part'), corners = numbers('connectivity'), ends = numbers('offsets');
  const points = Array.from({ length: flat.length / 3 }, (_, k) => flat.slice(3 * k, 3 * k + 3));
  const polygons = ends.map((end, k) => ({ part: parts[k], corners: corners.slice(k ? ends[k - 1] : 0, end) }));
  return { points, polygons, time: numbers('time')[0], turned: numbers('drum_angle')[0] || 0 };
}

function normalOf(points, corners) {
  const [a, b, c] = [corners[0], corners[1], corners[2]].map(k => points[k]);
  const u = b.map((x, k) => x - a[k]), v = c.map((x, k) => x - a[k]);
  const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const size = Math.hypot(...n) || 1;
  return n.map(x => x / size);
}

// {lines: [x, y, z, x, y, z] of each edge and faint: whether it is but a mark, moves: of the shell or what turns with it;
//  faces: triangles as [x, y, z] x 3}. isDrum: all turns; else the shell alone may rise.
export function wallGeometry({ points, polygons }, isDrum) {
  const edges = new Map(); // of all polygons of a part
  polygons.forEach(({ part, corners }, polygon) => corners.forEach((a, k) => {
    const b = corners[(k + 1) % corners.length], key = `${part} ${Math.min(a, b)} ${Math.max(a, b)}`;
    if (!edges.has(key)) edges.set(key, { part, a, b, of: [] });
    edges.get(key).of.push(polygon);
  }));
  const normals = polygons.map(({ corners }) => normalOf(points, corners));
  const cosine = ([one, two]) => Math.abs(normals[one].reduce((sum, x, k) => sum + x * normals[two][k], 0));
  const lines = [];
  let strip = 0;
  for (const { part, a, b, of } of edges.values()) {
    const isSharp = of.length < 2 || cosine(of) < SHARP;
    const isMark = !isSharp && part === SHELL && strip++ % EVERY === 0;
    if (isSharp || isMark) lines.push({ ends: [...points[a], ...points[b]], isFaint: isMark, moves: isDrum || part === SHELL });
  }
  const faces = [];
  for (const { part, corners } of polygons) {
    if (part !== LIFTER && part !== PLATE && !(part === END && isDrum && points[corners[0]][2] < 0)) continue;
    for (let k = 2; k < corners.length; k++)
      faces.push({ corners: [0, k - 1, k].flatMap(c => points[corners[c]]), moves: isDrum, isOfBars: part === LIFTER });
  }
  const shell = polygons.filter(({ part }) => part === SHELL).flatMap(({ corners }) => corners.map(k => points[k][2]));
  return { lines, faces, shellLow: shell.reduce((low, z) => Math.min(low, z), Infinity) };
}

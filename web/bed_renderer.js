// Spheres and walls drawn by WebGL2. A sphere is a square that faces the viewer; each of its pixels knows how far the sphere
// bulges there, which gives its light and its depth, so that spheres cut one another and the walls as they should. One drawing
// surface serves all views of a page: a view copies what was drawn, and nothing is drawn but on demand.

const HEAD = `#version 300 es
precision highp float; precision highp int;
uniform mat3 toView; uniform vec3 center, scale; uniform vec2 pan;
vec4 place(vec3 v) { return vec4(v.xy * scale.xy + pan, -v.z * scale.z, 1.0); }`;

const SPHERE_VERTEX = `${HEAD}
in vec2 corner; in vec3 position; in float size; in vec3 color;
uniform vec3 low, high; uniform float largest, cut; uniform vec3 depthAxis;
out vec2 at; out vec3 paint; out float bulge, depth;
void main() {
  vec3 world = low + (position + 32767.0) / 65534.0 * (high - low);
  vec3 v = toView * (world - center);
  float radius = size * largest;
  at = corner; paint = color; bulge = radius * scale.z; depth = v.z * scale.z;
  gl_Position = dot(world - center, depthAxis) > cut ? vec4(2.0, 2.0, 2.0, 1.0) : place(v + vec3(corner * radius, 0.0));
}`;

const SPHERE_FRAGMENT = `#version 300 es
precision highp float;
in vec2 at; in vec3 paint; in float bulge, depth; uniform vec3 paper; out vec4 result;
void main() {
  float inside = 1.0 - dot(at, at);
  if (inside < 0.0) discard;
  vec3 normal = vec3(at, sqrt(inside));
  float height = depth + bulge * normal.z;
  gl_FragDepth = 0.5 - 0.5 * height;
  float light = max(dot(normal, vec3(-0.37, 0.56, 0.74)), 0.0);
  float gloss = pow(max(dot(normal, vec3(-0.2, 0.3, 0.93)), 0.0), 24.0);
  vec3 lit = paint * (0.38 + 0.66 * light) * smoothstep(0.0, 0.35, normal.z + 0.12) + 0.14 * gloss;
  result = vec4(mix(lit, paper, 0.38 * smoothstep(0.0, 1.0, -0.5 * depth + 0.05)), 1.0);
}`;

const WALL_VERTEX = `${HEAD}
in vec3 position; in vec3 other; in vec4 color; in float side; in float moves;
uniform float turned, raised, thickness; uniform vec2 pixels;
out vec4 paint;
vec3 moved(vec3 p) {
  float c = cos(turned), s = sin(turned);
  return moves > 0.5 ? vec3(c * p.x - s * p.y, s * p.x + c * p.y, p.z + raised) : p;
}
void main() {
  vec4 here = place(toView * (moved(position) - center)), there = place(toView * (moved(other) - center));
  vec2 along = (there.xy - here.xy) * pixels;
  vec2 across = dot(along, along) > 0.0 ? normalize(vec2(-along.y, along.x)) : vec2(1.0, 0.0);
  paint = color;
  gl_Position = here + vec4(across * side * thickness / pixels, 0.0, 0.0);
}`;

const WALL_FRAGMENT = `#version 300 es
precision highp float;
in vec4 paint; out vec4 result;
void main() { result = vec4(paint.rgb * paint.a, paint.a); }`;

const THINNED_TO = 20_000; // spheres, where a processor draws them

function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader) ?? 'no context');
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  return made;
}

function isOfProcessor(gl) {
  const told = gl.getExtension('WEBGL_debug_renderer_info');
  return /swiftshader|llvmpipe|software|basic render/i.test(gl.getParameter(told ? told.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
}

let shared; // undefined: not tried yet; null: this browser has no WebGL2

// null where there is no WebGL2.
export function sharedRenderer() {
  if (shared === undefined || shared?.gl.isContextLost()) shared = createRenderer();
  return shared;
}

function createRenderer() {
  const canvas = document.createElement('canvas');
  const gl = canvas.getContext('webgl2', { antialias: true, alpha: true });
  if (!gl) return null;
  canvas.addEventListener('webglcontextlost', event => event.preventDefault());
  const spheres = program(gl, SPHERE_VERTEX, SPHERE_FRAGMENT), walls = program(gl, WALL_VERTEX, WALL_FRAGMENT);
  const slow = isOfProcessor(gl), buffers = new Map();

  // An attribute from an array, whose every entry is for one instance (per 1), or one corner (per 0).
  function feed(shader, name, array, width, { type = gl.FLOAT, normalized = false, stride = 0, per = 0 } = {}) {
    const where = gl.getAttribLocation(shader, name);
    if (where < 0) return;
    if (!buffers.has(name)) buffers.set(name, gl.createBuffer());
    gl.bindBuffer(gl.ARRAY_BUFFER, buffers.get(name));
    gl.bufferData(gl.ARRAY_BUFFER, array, gl.STREAM_DRAW);
    gl.enableVertexAttribArray(where);
    gl.vertexAttribPointer(where, width, type, normalized, stride, 0);
    gl.vertexAttribDivisor(where, per);
  }
  const uniform = (shader, name) => gl.getUniformLocation(shader, name);

  function look(shader, view) {
    gl.useProgram(shader);
    for (let k = 0; k < 8; k++) gl.disableVertexAttribArray(k);
    gl.uniformMatrix3fv(uniform(shader, 'toView'), true, view.toView.flat());
    gl.uniform3fv(uniform(shader, 'center'), view.center);
    gl.uniform3fv(uniform(shader, 'scale'), view.scale);
    gl.uniform2fv(uniform(shader, 'pan'), view.pan);
  }

  function drawSpheres(frame, colors, view) {
    const every = slow ? Math.ceil(frame.count / THINNED_TO) : 1, shown = Math.ceil(frame.count / every);
    look(spheres, view);
    gl.uniform3fv(uniform(spheres, 'low'), frame.low);
    gl.uniform3fv(uniform(spheres, 'high'), frame.high);
    gl.uniform3fv(uniform(spheres, 'depthAxis'), view.depthAxis);
    gl.uniform3fv(uniform(spheres, 'paper'), view.paper);
    gl.uniform1f(uniform(spheres, 'largest'), frame.largestRadius);
    gl.uniform1f(uniform(spheres, 'cut'), view.cut);
    feed(spheres, 'corner', new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), 2);
    feed(spheres, 'position', frame.position, 3, { type: gl.SHORT, stride: 6 * every, per: 1 });
    feed(spheres, 'color', colors, 3, { type: gl.UNSIGNED_BYTE, normalized: true, stride: 3 * every, per: 1 });
    if (frame.radius) feed(spheres, 'size', frame.radius, 1, { type: gl.UNSIGNED_SHORT, normalized: true, stride: 2 * every, per: 1 });
    else gl.vertexAttrib1f(gl.getAttribLocation(spheres, 'size'), 1);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, shown);
    return shown;
  }

  function drawWalls(mesh, view) {
    if (mesh.count === 0) return;
    look(walls, view);
    gl.uniform1f(uniform(walls, 'turned'), view.turned);
    gl.uniform1f(uniform(walls, 'raised'), view.raised);
    gl.uniform1f(uniform(walls, 'thickness'), view.thickness);
    gl.uniform2f(uniform(walls, 'pixels'), canvas.width, canvas.height);
    for (const [name, width] of [['position', 3], ['other', 3], ['color', 4], ['side', 1], ['moves', 1]]) feed(walls, name, mesh[name], width);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.drawArrays(gl.TRIANGLES, 0, mesh.count);
    gl.disable(gl.BLEND);
  }

  // Draws the frame (null: walls alone) and returns how many spheres it drew. mesh: of wallMesh.
  function draw(frame, colors, mesh, view, width, height) {
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    const shown = frame ? drawSpheres(frame, colors, view) : 0;
    drawWalls(mesh, view);
    return shown;
  }
  return { gl, canvas, draw, isSlow: slow };
}

// The walls' lines and faces as arrays for draw(). ink, quiet: colours as [r, g, b] from 0 to 1.
export function wallMesh({ lines, faces }, ink) {
  const mesh = { position: [], other: [], color: [], side: [], moves: [] };
  const add = (here, there, side, color, moves) => {
    mesh.position.push(...here);
    mesh.other.push(...there);
    mesh.color.push(...color);
    mesh.side.push(side);
    mesh.moves.push(moves ? 1 : 0);
  };
  for (const { ends, isFaint, moves } of lines) {
    const a = ends.slice(0, 3), b = ends.slice(3), color = [...ink, isFaint ? 0.35 : 1];
    // towards the other end, its left is the first end's right
    for (const [here, there, side] of [[a, b, 1], [a, b, -1], [b, a, 1], [b, a, 1], [b, a, -1], [a, b, 1]]) add(here, there, side, color, moves);
  }
  for (const { corners, moves, isOfBars } of faces)
    for (let k = 0; k < 9; k += 3) add(corners.slice(k, k + 3), corners.slice(k, k + 3), 0, [...ink, isOfBars ? 0.5 : 0.14], moves);
  return { ...Object.fromEntries(Object.entries(mesh).map(([name, list]) => [name, new Float32Array(list)])), count: mesh.side.length };
}

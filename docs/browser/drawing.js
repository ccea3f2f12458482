// The picture: the arm and what is beside it in WebGL, and lines over them.

// The camera looks at a point from a direction; screen and room agree on it.
let azimuth = 0.55, elevation = 0.42, away = 1.4;
const LOOK = [0.2, 0.14, 0.42], FOCAL = 1.9;
let camera = null;
function aim() {
  const c = Math.cos(elevation);
  const back = [c * Math.cos(azimuth), c * Math.sin(azimuth), Math.sin(elevation)];
  const right = unit(cross([0, 0, 1], back));
  camera = {eye: sum(LOOK, back.map(x => away * x)), right, up: cross(back, right), back};
}
const over = el("over"), pen = over.getContext("2d"), lit = el("lit");
// The height counts on a wide stage, the width on a narrow one.
const focal = () => FOCAL * Math.min(1, 1.25 * over.width / over.height);
function shown(p) {
  const d = minus(p, camera.eye), depth = -dot(d, camera.back), f = 0.5 * over.height * focal() / depth;
  return [0.5 * over.width + f * dot(d, camera.right), 0.5 * over.height - f * dot(d, camera.up), depth];
}
// Size of a metre in pixels at a point.
const scale = p => 0.5 * over.height * focal() / shown(p)[2];

// WebGL: cylinders, balls and the floor, each lit from above, and their shadows.
const gl = lit.getContext("webgl", {antialias: true, stencil: true, alpha: true, preserveDrawingBuffer: true});
const VERTEX = `attribute vec3 at, normal; uniform mat3 R; uniform vec3 p, eye, right, up, back, sun; uniform float focal, aspect, flat_;
varying vec3 n, w; void main() { w = R * at + p; n = normalize(R * normal);
if (flat_ > 0.5) w = vec3(w.xy - sun.xy / sun.z * w.z, 0.001);
vec3 d = w - eye; float z = -dot(d, back); gl_Position = vec4(focal / aspect * dot(d, right), focal * dot(d, up), z * 1.01 - 0.2, z); }`;
const FRAGMENT = `precision highp float; uniform vec3 color, eye, sun; uniform float flat_, floor_; varying vec3 n, w;
void main() { if (flat_ > 0.5) { gl_FragColor = vec4(0.0, 0.0, 0.0, 0.28); return; }
if (floor_ > 0.5) { vec2 g = abs(fract(w.xy * 4.0) - 0.5); float tile = mod(floor(w.x * 4.0) + floor(w.y * 4.0), 2.0);
float far = smoothstep(1.1, 0.5, length(w.xy - vec2(0.2, 0.15))); gl_FragColor = vec4(color, 1.0) * far * (0.75 + 0.25 * tile); return; }
vec3 v = normalize(eye - w), s = normalize(sun); float d = max(dot(n, s), 0.0), h = pow(max(dot(n, normalize(v + s)), 0.0), 40.0);
gl_FragColor = vec4(color * (0.48 + 0.2 * n.z + 0.5 * d) + 0.25 * h, 1.0); }`;
const program = gl && gl.createProgram();
const uniform = {};
function prepare() {
  for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  gl.useProgram(program);
  for (const name of ["R", "p", "eye", "right", "up", "back", "sun", "focal", "aspect", "flat_", "floor_", "color"])
    uniform[name] = gl.getUniformLocation(program, name);
}
// Corners and normals of a shape's side and of its two ends.
function solid(each) {
  const [a, b] = each.ends, way = minus(b, a), high = Math.hypot(...way);
  const z = high ? unit(way) : [0, 0, 1], x = unit(cross(Math.abs(z[0]) < 0.7 ? [1, 0, 0] : [0, 1, 0], z)), y = cross(z, x);
  const rings = [], N = 40, r = each.radius;
  if (each.round) for (let k = 0; k <= 24; k++) {
    const e = Math.PI * (k / 24 - 0.5);
    rings.push([sum(k < 12 ? a : b, z.map(v => v * r * Math.sin(e))), r * Math.cos(e), Math.cos(e), Math.sin(e)]);
  } else {
    const f = Math.min(0.006, 0.4 * high), inner = r - f;  // a chamfer catches the light
    const rim = [[a, 0, 0, -1], [a, inner, 0, -1], [a, inner, 0.7, -0.7], [sum(a, z.map(v => f * v)), r, 0.7, -0.7],
      [sum(a, z.map(v => f * v)), r, 1, 0], [sum(b, z.map(v => -f * v)), r, 1, 0], [sum(b, z.map(v => -f * v)), r, 0.7, 0.7],
      [b, inner, 0.7, 0.7], [b, inner, 0, 1], [b, 0, 0, 1]];
    rings.push(...rim);
  }
  const data = [];
  const corner = ([c, radius, out, upward], k) => {
    const s = 2 * Math.PI * k / N, side = x.map((v, i) => v * Math.cos(s) + y[i] * Math.sin(s));
    data.push(...sum(c, side.map(v => radius * v)), ...side.map((v, i) => out * v + upward * z[i]));
  };
  for (let i = 0; i + 1 < rings.length; i++) for (let k = 0; k < N; k++)
    for (const [ring, step] of [[i, 0], [i, 1], [i + 1, 1], [i, 0], [i + 1, 1], [i + 1, 0]]) corner(rings[ring], k + step);
  return upload(data);
}
function upload(data) {
  const buffer = gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(data), gl.STATIC_DRAW);
  return {buffer, count: data.length / 6};
}
const EYE3 = [1, 0, 0, 0, 1, 0, 0, 0, 1];
let parts = [], sphere = null, ground = null;
if (gl) {
  prepare();
  parts = MODEL.shapes.map(each => ({...each, solid: solid(each)}));
  sphere = solid({ends: [[0, 0, 0], [0, 0, 0]], radius: 1, round: true});
  const corners = [[-2, -2], [2, -2], [2, 2], [-2, -2], [2, 2], [-2, 2]];
  ground = upload(corners.flatMap(([x, y]) => [x, y, 0, 0, 0, 1]));
}
function show(mesh, R, p, color) {
  gl.bindBuffer(gl.ARRAY_BUFFER, mesh.buffer);
  ["at", "normal"].forEach((name, i) => {
    const at = gl.getAttribLocation(program, name);
    if (at < 0) return;
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, 3, gl.FLOAT, false, 24, 12 * i);
  });
  gl.uniformMatrix3fv(uniform.R, false, [R[0], R[3], R[6], R[1], R[4], R[7], R[2], R[5], R[8]]);
  gl.uniform3fv(uniform.p, p);
  gl.uniform3fv(uniform.color, color);
  gl.drawArrays(gl.TRIANGLES, 0, mesh.count);
}
function render(found, hot, near) {
  gl.viewport(0, 0, lit.width, lit.height);
  gl.clearColor(0, 0, 0, 0);
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT | gl.STENCIL_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  gl.enable(gl.BLEND);
  gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  for (const name of ["eye", "right", "up", "back"]) gl.uniform3fv(uniform[name], camera[name]);
  gl.uniform3fv(uniform.sun, [-0.35, 0.3, 1]);
  gl.uniform1f(uniform.focal, focal());
  gl.uniform1f(uniform.aspect, lit.width / lit.height);
  const dark = matchMedia("(prefers-color-scheme: dark)").matches;
  gl.uniform1f(uniform.flat_, 0);
  gl.uniform1f(uniform.floor_, 1);
  show(ground, EYE3, [0, 0, 0], dark ? [0.2, 0.23, 0.28] : [0.82, 0.85, 0.89]);
  gl.uniform1f(uniform.floor_, 0);
  const everything = () => {
    for (const each of parts) {
      const [R, p] = found[each.joint];
      show(each.solid, R, p, hot[each.joint - 1] ? each.color.map((c, i) => 0.35 * c + 0.65 * HOT[i]) : each.color);
    }
    for (const {at, radius, color} of [...scene.things, ...scene.carried?.(found) ?? []])
      show(sphere, EYE3.map(x => radius * x), Array.from(at.slice(0, 3)), near && at === scene.body.at ? HOT : color);
  };
  // Each point of the floor is darkened once.
  gl.uniform1f(uniform.flat_, 1);
  gl.enable(gl.STENCIL_TEST);
  gl.stencilFunc(gl.EQUAL, 0, 255);
  gl.stencilOp(gl.KEEP, gl.KEEP, gl.INCR);
  gl.depthMask(false);
  everything();
  gl.depthMask(true);
  gl.disable(gl.STENCIL_TEST);
  gl.uniform1f(uniform.flat_, 0);
  everything();
}

function line(points, color, width) {
  pen.beginPath();
  points.forEach((p, i) => pen[i ? "lineTo" : "moveTo"](...shown(p)));
  pen.strokeStyle = color;
  pen.lineWidth = width * devicePixelRatio;
  pen.lineJoin = pen.lineCap = "round";
  pen.stroke();
}

function circle(p, radius, color, dashes = []) {
  pen.beginPath();
  pen.arc(...shown(Array.from(p.slice(0, 3))).slice(0, 2), radius, 0, 2 * Math.PI);
  pen.strokeStyle = color;
  pen.lineWidth = 1.5 * devicePixelRatio;
  pen.setLineDash(dashes.map(x => x * devicePixelRatio));
  pen.stroke();
  pen.setLineDash([]);
}
function note(p, words) {
  const [x, y] = shown(Array.from(p));
  pen.font = `${13 * devicePixelRatio}px system-ui, sans-serif`;
  pen.fillStyle = "#e5383b";
  pen.textAlign = "center";
  pen.fillText(words, x, y + 40 * devicePixelRatio);
}

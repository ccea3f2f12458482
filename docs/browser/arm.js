// The arm in numbers: matrices, kinematics, and the code that computes its commands.
const el = id => document.getElementById(id);

// Row-major 3 x 3 matrices and points.
const times = (A, B) => [0, 3, 6].flatMap(i => [0, 1, 2].map(j => A[i] * B[j] + A[i + 1] * B[j + 3] + A[i + 2] * B[j + 6]));
const turned = (A, x) => [0, 3, 6].map(i => A[i] * x[0] + A[i + 1] * x[1] + A[i + 2] * x[2]);
const sum = (a, b) => a.map((x, i) => x + b[i]);
const minus = (a, b) => a.map((x, i) => x - b[i]);
const dot = (a, b) => a.reduce((s, x, i) => s + x * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = a => a.map(x => x / Math.hypot(...a));
// The rotation by an angle about a unit vector.
function about([x, y, z], angle) {
  const c = Math.cos(angle), s = Math.sin(angle), d = 1 - c;
  return [c + d * x * x, d * x * y - s * z, d * x * z + s * y,
          d * x * y + s * z, c + d * y * y, d * y * z - s * x,
          d * x * z - s * y, d * y * z + s * x, c + d * z * z];
}

// Rotations and origins of the base, of all joints and of the tip.
function frames(q) {
  let R = [1, 0, 0, 0, 1, 0, 0, 0, 1], p = [0, 0, 0];
  const found = [[R, p]];
  MODEL.joints.forEach((joint, i) => {
    p = sum(p, turned(R, joint.translation));
    R = times(times(R, joint.rotation), about(joint.axis, q[i]));
    found.push([R, p]);
  });
  found.push([R, sum(p, turned(R, MODEL.tip))]);
  return found;
}
const skeleton = q => frames(q).map(([, p]) => p);

const imports = {env: {sin: Math.sin, cos: Math.cos, atan2: Math.atan2, ceil: Math.ceil, floor: Math.floor, fmod: (x, y) => x % y}};
const wasm = new WebAssembly.Instance(new WebAssembly.Module(code), imports).exports;
const view = (at, size) => new Float64Array(wasm.memory.buffer, wasm[at].value, size);
const n = MODEL.joints.length;
const q = view("q", n), dq = view("dq", n), target = view("target", 18);

// The link that is nearest to a ball, of those from one joint on whose capsules the limits know, and its distance.
function nearest(found, at, radius, first = 0) {
  return MODEL.capsules.filter(({joint}) => joint >= first).map(({joint, link, ends, radius: own}) => {
    const [R, p] = found[joint], [a, b] = ends.map(x => sum(p, turned(R, x)));
    const way = minus(b, a), s = Math.max(0, Math.min(1, dot(minus(at, a), way) / (dot(way, way) || 1)));
    return {link, distance: Math.hypot(...minus(at, sum(a, way.map(x => s * x)))) - own - radius};
  }).reduce((least, each) => each.distance < least.distance ? each : least);
}
const clearance = (found, body = scene.body) => nearest(found, body.at, body.radius).distance;

const HOT = [0.95, 0.16, 0.18], BLUE = [0.25, 0.52, 0.85];

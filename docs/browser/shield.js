// A shield in front of what is asked: by a handle that pulls at the tip, or by a stream of positions.
const ball = view("ball", 3), request = view("request", n), sample = view("sample", n), seen = view("seen", 7);
const twist = request.subarray(0, 6), hand = new Float64Array(3), HAND = MODEL.hand;
const obstacle = {...MODEL.ball, at: ball, color: BLUE, grip: 30};
const person = {...HAND, at: hand, color: [0.87, 0.64, 0.5], grip: 30, goal: null};
const handle = {at: target, radius: 0.014, color: HOT, grip: 44};
let table = 0;

// Load the tables of a shield, for an arm that rests.
function load(number) {
  table = number;
  wasm.begin(table);
}
const due = periods => Math.round(t / MODEL.dt) % periods === 0;

// The handle asks for a velocity of the tip. Let go, it roams, out of reach and through the ball.
function pull() {
  if (handle.free) target.set([0.45 + 0.3 * Math.sin(0.9 * t), 0.1 + 0.5 * Math.cos(1.3 * t), 0.5 + 0.35 * Math.cos(0.7 * t)]);
  twist.set(minus(Array.from(target.slice(0, 3)), skeleton(q).pop()).map(x => 6 * x));
}
function pulled() {
  if (due(16)) pull();
  return wasm.step(MODEL.kinds.TWIST);
}

// What keeps the shield's command from the request, in words; first those of a kind.
function limits(first = "") {
  const names = Array.from({length: wasm.count_limits()}, (_, i) => {
    const text = new Uint8Array(wasm.memory.buffer, wasm.limit_name(i));
    return new TextDecoder().decode(text.subarray(0, text.indexOf(0))).replace(/^row \d+ of TorqueLimits \((.*)\)$/, "$1");
  });
  if (first) names.sort((a, b) => b.includes(first) - a.includes(first));
  const at = names.indexOf("separation");
  if (at >= 0) names[at] = `separation of ${nearest(frames(q), Array.from(seen.slice(0, 3)), HAND.radius, 1).link} from person 1`;
  return names.slice(0, 3).join(", ") + (names.length > 3 ? `, ${names.length - 3} more` : "");
}
const answer = () => [action ? "limited by " + limits(scene.first) : "as requested", `can stop within ${(1e3 * wasm.stopping_time()).toFixed(0)} ms`];

// The hand goes where it is dragged, no quicker than it may. A camera sees it, and says so later. Let go, it comes and leaves.
let track = [], taken = 0;
function move_hand() {
  track.push(Array.from(hand));
  if (track.length > HAND.late + 1) track.shift();
  if (due(HAND.every)) {
    const age = (track.length - 1) * MODEL.dt;
    taken = t - age;
    seen.set([...track[0], ...track[0], HAND.radius]);
    wasm.see(age);
  }
  if (person.free) person.goal = t % 7 < 3.5 ? HAND.center : HAND.near;
  const way = minus(person.goal, Array.from(hand)), most = HAND.speed * MODEL.dt / Math.hypot(...way);
  hand.set(most < 1 ? sum(Array.from(hand), way.map(x => most * x)) : person.goal);
}

// Joint positions from others on that bring the tip near a point, by damped least squares.
function reach(point, posture) {
  for (let k = 0; k < 20; k++) {
    const found = frames(posture), tip = found[n + 1][1], off = minus(point, tip), far = Math.hypot(...off);
    const columns = MODEL.joints.map((joint, i) => cross(turned(found[i + 1][0], joint.axis), minus(tip, found[i + 1][1])));
    const [a, b, c] = [0, 1, 2].map(i => [0, 1, 2].map(j => columns.reduce((s, x) => s + x[i] * x[j], i === j ? 1e-3 : 0)));
    const inverse = [cross(b, c), cross(c, a), cross(a, b)], part = Math.min(1, 0.05 / far) / dot(a, inverse[0]);
    const push = [0, 1, 2].map(i => part * inverse.reduce((s, x, j) => s + x[i] * off[j], 0));
    posture = posture.map((x, i) => Math.max(MODEL.lower[i] + 0.01, Math.min(MODEL.upper[i] - 0.01, x + dot(columns[i], push))));
  }
  return posture;
}

// A target of 30 Hz as a stream of joint positions. Let go, it draws an eight.
let goal = [], asked = [];
function send() {
  const home = skeleton(MODEL.start).pop(), grown = Math.min(1, t / 3);
  if (handle.free) target.set(sum(home, [0.08 * Math.sin(2.4 * t), 0.3 * Math.sin(1.2 * t), 0.1 * Math.sin(1.2 * t)].map(x => grown * x)));
  const point = Array.from(target.slice(0, 3));
  asked.push({t, point});
  if (asked.length > 600) asked.shift();
  if (!due(33)) return;
  goal = reach(point, goal);
  sample.set(goal);
  wasm.follow(t, scene.dial.at);
}
// Time since the target was nearest to where the tip is, and the distance then.
function lag() {
  const tip = skeleton(q).pop();
  return asked.map(each => ({late: t - each.t, off: Math.hypot(...minus(tip, each.point))}))
    .reduce((least, each) => each.off <= least.off ? each : least, {late: 0, off: Infinity});
}

const SCENES = {
  ball: {
    label: "ball",
    words: "Drag the red handle, which pulls at the tip of the arm, or the blue ball. The handle requests a velocity of the tip, 6/s times its distance.",
    things: [handle, obstacle],
    body: obstacle,
    begin() { ball.set(MODEL.ball.center); load(0); },
    step: pulled,
    say: () => answer(),
  },
  person: {
    label: "person",
    first: "separation",
    words: `Drag the hand: the arm rests before it is touched, and goes on when the hand leaves. That is promised for a body of at most ${HAND.speed} m/s, so the hand follows the pointer no quicker. A camera sees it at 30 Hz, ${HAND.late} ms late; the dashed circle, where it can be until the arm rests, has no moving link.`,
    things: [handle, person],
    body: person,
    begin() { hand.set(HAND.center); track = []; load(1); },
    step() { move_hand(); return pulled(); },
    draw() {
      const there = Array.from(seen.slice(0, 3));
      circle(there, (HAND.radius + HAND.distance + HAND.speed * (t - taken + wasm.stopping_time())) * scale(there), "#e5383b99", [6, 6]);
      if (person.free || Math.hypot(...minus(person.goal, Array.from(hand))) < 0.01) return;
      line([Array.from(hand), person.goal], "#e5383b", 1.5);
      note(hand, `${HAND.speed} m/s at most`);
    },
    say: () => [...answer(), `${(1e3 * wasm.separation()).toFixed(0)} mm of separation to spare`],
  },
  weight: {
    label: "weight",
    first: "torque",
    words: "Choose a weight: the arm goes back, takes it at the flange, and no torque exceeds its limit, in motion and until rest. 7 kg is what it is rated for.",
    things: [handle],
    dial: {words: MODEL.weights.map(mass => `weight ${mass} kg`), at: 1},
    begin() { load(2 + this.dial.at); },
    step() {
      if (table === 2 + this.dial.at) return pulled();
      const there = q.every((x, i) => Math.abs(x - MODEL.start[i]) < 1e-3);
      if (there && dq.every(x => x === 0)) load(2 + this.dial.at);
      request.set(there ? dq.map(() => 0) : MODEL.start);
      return wasm.step(there ? MODEL.kinds.VELOCITY : MODEL.kinds.POSITION);
    },
    carried(found) {
      const [R, p] = found[n + 1], mass = MODEL.weights[table - 2];
      return mass ? [{at: sum(p, turned(R, MODEL.weight_center)), radius: MODEL.weight_radius * Math.cbrt(mass), color: [0.45, 0.47, 0.5]}] : [];
    },
    say: () => [...answer(), `${(100 * wasm.torque()).toFixed(0)} % of the torque limit to spare`],
  },
  stream: {
    label: "stream",
    words: "Drag the red target: 30 times a second its position becomes one of all joints, which the arm follows as smoothly as its limits permit. Leads of 0, 1 and 2 samples make it two, one and none late.",
    things: [handle],
    dial: {words: [0, 1, 2].map(lead => `lead ${lead}`), at: 1},
    begin() {
      ball.set([0, 0, -1]);
      load(0);
      goal = MODEL.start;
      asked = [];
    },
    step() {
      send();
      return wasm.step(MODEL.kinds.NONE);
    },
    draw() { for (const {point} of asked.filter(each => Math.round(each.t / MODEL.dt) % 33 === 0)) circle(point, 2 * devicePixelRatio, "#3b8bd6"); },
    say() {
      const {late, off} = lag();
      return [...answer(), `tip ${(1e3 * late).toFixed(0)} ms behind the target, ${(1e3 * off).toFixed(1)} mm beside its way`];
    },
  },
};

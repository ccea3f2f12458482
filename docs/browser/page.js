// The page: a scene, its steps in real time, and the pointer.
let scene = null, t = 0, trail = [], action = 0, cost = 0, last = null;
let before = new Float64Array(n), speedup = new Float64Array(n), fractions = [];

function begin() {
  q.set(MODEL.start);
  t = 0;
  trail = [];
  before = new Float64Array(n);
  speedup = new Float64Array(n);
  for (const thing of scene.things) thing.free = true;
  scene.begin();
}

function choose(name) {
  scene = SCENES[name];
  for (const button of el("scenes").children) button.ariaPressed = button.id === name;
  el("words").textContent = scene.words;
  el("dial").hidden = !scene.dial;
  if (scene.dial) turn(scene.dial.at);
  begin();
}
function turn(at) {
  scene.dial.at = at;
  el("knob").max = scene.dial.words.length - 1;
  el("knob").value = at;
  el("turned").textContent = scene.dial.words[at];
}

// Run for a number of control periods; keep the largest fraction of each limit.
function run(steps) {
  fractions = MODEL.limits.map(() => [0, 0, 0, 0]);
  for (let k = 0; k < steps; k++) {
    action = scene.step();
    t += MODEL.dt;
    for (let i = 0; i < n; i++) {
      const a = (dq[i] - before[i]) / MODEL.dt, j = (a - speedup[i]) / MODEL.dt;
      const middle = 0.5 * (MODEL.upper[i] + MODEL.lower[i]);
      const now = [Math.abs(q[i] - middle) / (MODEL.upper[i] - middle), Math.abs(dq[i]) / MODEL.limits[i],
                   Math.abs(a) / MODEL.acceleration[i], Math.abs(j) / MODEL.jerk[i]];
      now.forEach((x, m) => { fractions[i][m] = Math.max(fractions[i][m], x); });
      before[i] = dq[i];
      speedup[i] = a;
    }
  }
}

const cells = MODEL.limits.map((_, i) => {
  const row = el("rows").insertRow();
  row.insertCell().textContent = i + 1;
  return [0, 1, 2, 3].map(() => {
    const cell = row.insertCell();
    cell.innerHTML = "<i><b></b></i>";
    return cell;
  });
});

function draw() {
  for (const canvas of [lit, over]) {
    canvas.width = canvas.clientWidth * devicePixelRatio;
    canvas.height = canvas.clientHeight * devicePixelRatio;
  }
  aim();
  const found = frames(q), body = scene.body, near = body && clearance(found);
  const hot = fractions.map(row => row.some((x, m) => m < 3 && x > 0.995));
  if (gl) render(found, hot, body && near < body.distance + 1e-3);
  else line(found.map(([, p]) => p), "#8a94a6", 14);
  scene.draw?.();
  line(trail, "#e5383b", 2.5);
  circle(handle.at, 16 * devicePixelRatio, "#e5383b");
  fractions.forEach((row, i) => row.forEach((x, m) => {
    cells[i][m].className = x > 0.995 ? "hot" : "";
    cells[i][m].querySelector("b").style.width = `${Math.min(100, 100 * x)}%`;
  }));
  const said = scene.say();
  if (body) said.push(`${body.name} ${near > 0 ? (1e3 * near).toFixed(0) + " mm away" : "touches the arm"}`);
  el("state").innerHTML = [...said, `a step of 1 ms takes ${cost.toFixed(0)} µs`].join("<br>");
}

function frame(now) {
  // Where steps are too slow for real time, the motion is slower, not the pictures.
  const most = Math.max(1, Math.min(60, Math.floor(25e3 / cost)));
  const steps = last === null ? 0 : Math.min(most, Math.round((now - last) / 1000 / MODEL.dt));
  last = now;
  const started = performance.now();
  if (steps) run(steps);
  if (steps) cost += 0.05 * (1e3 * (performance.now() - started) / steps - cost);
  trail.push(skeleton(q).pop());
  if (trail.length > 900) trail.shift();
  draw();
  requestAnimationFrame(frame);
}

// The pointer takes what is nearest to it and moves it in the screen's plane; elsewhere it turns the view.
const stage = el("stage");
let held = null;
const pixel = event => {
  const box = stage.getBoundingClientRect();
  return [(event.clientX - box.left) * devicePixelRatio, (event.clientY - box.top) * devicePixelRatio];
};
stage.addEventListener("pointerdown", event => {
  if (event.target.closest("button")) return;
  stage.setPointerCapture(event.pointerId);
  const [x, y] = pixel(event);
  const apart = ({at, grip, radius}) => {
    const point = Array.from(at.slice(0, 3)), [right, down] = shown(point);
    return Math.hypot(right - x, down - y) / Math.max(grip * devicePixelRatio, radius * scale(point));
  };
  held = {thing: scene.things.filter(thing => apart(thing) < 1).sort((a, b) => apart(a) - apart(b))[0], x, y};
});
stage.addEventListener("pointermove", event => {
  if (!held) return;
  const [x, y] = pixel(event), across = x - held.x, above = held.y - y, thing = held.thing;
  held.x = x;
  held.y = y;
  if (!thing) {
    azimuth -= 0.005 * across / devicePixelRatio;
    elevation = Math.max(0.05, Math.min(1.5, elevation - 0.005 * above / devicePixelRatio));
    return;
  }
  const goal = thing.goal, at = Array.from((goal && !thing.free ? goal : thing.at).slice(0, 3)), size = scale(at);
  const moved = at.map((v, i) => v + (across * camera.right[i] + above * camera.up[i]) / size);
  thing.free = false;
  if (goal) thing.goal = moved;
  else thing.at.set(moved);
  scene.dragged?.();
});
for (const name of ["pointerup", "pointercancel"]) stage.addEventListener(name, () => { held = null; });
stage.addEventListener("wheel", event => { away = Math.max(0.8, Math.min(4, away * Math.exp(0.001 * event.deltaY))); event.preventDefault(); }, {passive: false});
el("again").addEventListener("click", begin);
el("knob").addEventListener("input", event => turn(event.target.valueAsNumber));
const names = Object.keys(SCENES);
for (const name of names.length > 1 ? names : []) {
  const button = el("scenes").appendChild(document.createElement("button"));
  button.id = name;
  button.textContent = SCENES[name].label;
  button.addEventListener("click", () => choose(name));
}
choose(names.find(name => location.hash.includes(name)) ?? names[0]);
draw();
if (!location.hash.includes("still")) requestAnimationFrame(frame);

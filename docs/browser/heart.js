// A controller: the tip follows a path, or the target that a hand drags.
const ACTIONS = ["all that is asked", "all that is asked", "slower", "as near as the limits permit", "braking"];

const ball = view("ball", 3);
const obstacle = {...MODEL.ball, at: ball, color: BLUE, grip: 30};
const handle = {at: target, radius: 0.014, color: HOT, grip: 44};

const SCENES = {
  heart: {
    words: "Drag the red target or the blue ball. Out of reach the arm comes as near as it can.",
    things: [handle, obstacle],
    body: obstacle,
    begin() { ball.set(MODEL.ball.center); wasm.begin(); },
    step() { return wasm.step(t, handle.free ? 1 : 0); },
    dragged() { target.fill(0, 12, 18); },
    draw() {
      if (handle.free && t > 9) begin();
      if (handle.free) line(MODEL.path, "#8a93a088", 1.5);
    },
    say() {
      // The target is the one of the last step, which began where the arm was then.
      const then = skeleton(q.map((x, i) => x - MODEL.dt * dq[i])).pop();
      const off = Math.hypot(...minus(then, Array.from(target.slice(0, 3))));
      return [ACTIONS[action] ?? "no number",
              `tip off its target by ${off > 1e-3 ? (1e3 * off).toFixed(0) + " mm" : (1e6 * off).toFixed(1) + " µm"}`];
    },
  },
};

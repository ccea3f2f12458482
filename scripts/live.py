"""Drag a target in the browser and let the arm follow it: python scripts/live.py [ROBOT].

Beside the target there is a ball to drag against the arm, which gives way by its redundancy first.
Two rows of numbers ask the tip for a twist, as a gamepad does; a shield keeps it from the ball.
"""

import sys
import time
from dataclasses import replace

import numpy as np
import pinocchio as pin
import tyro

import iiwa_dnn
from iiwa_dnn.app.command_line import run_script
from iiwa_dnn.app.replay import aim, serve, show_robot

DT = 5e-3  # control period [s]
STEPS = 8  # of a tick: at 25 pictures a second the arm moves in real time
SPEED = 0.25  # of the target and of the ball [m/s]: the limit for robots beside people
RADIUS = 0.08  # of the ball [m]
SLIDERS = {"weight": 1.0, "drift_gain": 30.0, "position_gain": 30.0, "orientation_gain": 30.0}


def avoid(page):
    """Return the limit that keeps the arm away from a ball that is dragged about."""
    first = page.center.copy()

    class Dragged(iiwa_dnn.Sphere):
        def shift(self, t):
            return page.center - first

    ball = Dragged(first.tolist(), RADIUS, velocity=(SPEED, 0.0, 0.0))
    return iiwa_dnn.CollisionAvoidance([ball], self_collision=False, distance=0.03)


class Live:
    """A page on which an arm follows a target and keeps away from a ball."""

    def __init__(self, robot, host="127.0.0.1", port=8080):
        """Serve the page; `tick` moves it."""
        self.robot = robot
        self.q = np.array(robot.start_posture())
        start = iiwa_dnn.Configuration(robot, self.q)
        self.goal = iiwa_dnn.MovingTarget(start, speed=SPEED, rate=1.0)
        self.center = start.position + [0.0, 0.0, 0.5]  # of the ball [m]
        scheme = iiwa_dnn.DoubleIndicator(home=tuple(self.q), extra_limits=(avoid(self),))
        self.controller = iiwa_dnn.Controller(robot, scheme, self.goal, dt=DT)
        self.controller.warm_up(self.q)
        self.check = iiwa_dnn.CrossCheck()
        self.steps = 0
        self.server = serve(f"{robot.name} · live", host, port)
        self.arm = show_robot(self.server, robot)
        aim(self.server, start.position)
        scene = self.server.scene
        self.target = scene.add_transform_controls("/target", scale=0.2, position=start.position)
        self.target.wxyz = pin.Quaternion(start.rotation).coeffs()[[3, 0, 1, 2]]
        self.ball = scene.add_transform_controls(
            "/ball", scale=0.15, disable_rotations=True, position=self.center
        )
        self.sphere = scene.add_icosphere("/sphere", RADIUS, color=(64, 115, 191))
        gui = self.server.gui
        self.sliders = {
            name: gui.add_slider(name, 0.0, most, 0.01, getattr(scheme, name))
            for name, most in SLIDERS.items()
        }
        self.twist = [
            gui.add_vector3(name, (0.0, 0.0, 0.0), min=(-most,) * 3, max=(most,) * 3, step=0.01)
            for name, most in (("twist, linear [m/s]", SPEED), ("angular [rad/s]", 1.0))
        ]
        self.shield = None
        self.state = gui.add_markdown("")

    def tick(self):
        """Take the steps of a picture, and show the last one."""
        twist = np.concatenate([each.value for each in self.twist])
        state = self.drive(twist) if twist.any() else self.follow()
        self.arm.display(self.q)
        self.sphere.position = self.center
        self.state.content = state

    def drive(self, twist):
        """Ask a shield for a twist [m/s, rad/s] of the tip; the ball stands, the target follows."""
        if self.shield is None:
            ball = iiwa_dnn.Sphere(self.center.tolist(), RADIUS)
            self.shield = iiwa_dnn.Shield(self.robot, DT, [ball], 0.03)
        for _ in range(STEPS):
            command = self.shield.step(self.q, twist=twist)
            self.q = self.q + DT * command.dq
        tip = iiwa_dnn.Configuration(self.robot, self.q)
        self.goal = iiwa_dnn.MovingTarget(tip, speed=SPEED, rate=1.0)
        self.target.position = tip.position
        self.target.wxyz = pin.Quaternion(tip.rotation).coeffs()[[3, 0, 1, 2]]
        active_limits = ", ".join(command.active_limits)
        return f"twist {f'clipped by {active_limits}' if command.clipped else 'as requested'}"

    def follow(self):
        """Take the steps of a picture towards the target; return what is to be said of the last."""
        if self.shield is not None:
            self.shield = None
            self.controller.reference = self.goal
        left = np.asarray(self.ball.position) - self.center
        most = SPEED * STEPS * DT  # of the ball's path in a tick
        self.center = self.center + left * min(1.0, most / max(np.linalg.norm(left), 1e-9))
        chosen = {name: slider.value for name, slider in self.sliders.items()}
        scheme = replace(self.controller.scheme, **chosen)
        if scheme != self.controller.scheme:
            self.controller.scheme = scheme
        w, x, y, z = map(float, self.target.wxyz)
        rotation = pin.Quaternion(w, x, y, z).normalized().matrix()
        self.goal.set(self.target.position, rotation)
        for _ in range(STEPS):
            command = self.controller.step(self.q, self.steps * DT)
            self.q = self.q + DT * command.dq
            self.steps += 1
        gap = self.check.check(command.qp, command.solution.x).solution_gap[0, 0]
        active_limits = ", ".join(command.active_limits)
        done = (
            "as wanted" if command.ok else f"rate-limited by {active_limits or 'a singular pose'}"
        )
        return f"gap to ProxQP {gap:.1e} rad/s\n\nlast step {done}"


def main(
    robot: tyro.conf.Positional[str] = "iiwa7",
    host: str = "127.0.0.1",
    port: int = 8080,
    seconds: float = np.inf,
):
    """Serve the page for so many seconds, or until Ctrl-C."""
    page = Live(iiwa_dnn.load_robot(robot), host, port)
    print(f"open http://{host}:{page.server.get_port()} in a browser; Ctrl-C ends it", flush=True)
    end = time.monotonic() + seconds
    while (began := time.monotonic()) < end:
        page.tick()
        time.sleep(max(0.0, began + STEPS * DT - time.monotonic()))


if __name__ == "__main__":
    sys.exit(run_script(main))

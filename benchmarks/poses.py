"""Postures for random poses beside PlaCo's, Pink's and Pinocchio's iterated solvers.

``python -m benchmarks poses`` prints a table. A pose is that of a random posture within the joints'
limits, so that it can be reached. Every solver gets the same poses and the same starts, the arm's
start posture, whose CPU time is measured, and up to 19 random ones until one leads to the pose. An
answer counts if Pinocchio finds its tip within 1e-9 m and 1e-9 rad of the pose and its joints
within their limits. From each start a solver has 100 iterations, as `iiwa_dnn.solve_pose` has. Pink
takes whole steps (gain 1 in a step of 1 s), with the damping of its examples; Pinocchio's loop is
that of its inverse kinematics example, damped by 1e-12, its joints clipped to their limits. PlaCo
(``--placo-python``) has a soft frame task of weight 1 beside a regularization of 1e-6, as in its
examples, and runs in a process of its own.
"""

import argparse
import tempfile
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from functools import partial
from pathlib import Path

import numpy as np
import pink
import pinocchio as pin
from pink.limits import ConfigurationLimit
from pink.tasks import FrameTask

import iiwa_dnn
from benchmarks.arms import write_urdf
from benchmarks.braking import ARMS
from benchmarks.control import Driver, Loop
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.results.markdown import markdown_table

TOL = 1e-9
"""Largest error of a pose [m], [rad]."""

STARTS = 20
ITERATIONS = 100

Solver = Callable[[iiwa_dnn.Robot, pin.SE3, Vector], Vector]

Ask = Callable[[int, int], tuple[Vector, float]]
"""Looks for a pose from a start, both by number; returns joint positions and CPU time [s]."""

ROUNDED = 1.01
"""Ratio of an error to `TOL` that still counts: Pinocchio's rounding is another one."""


def own_postures(robot: iiwa_dnn.Robot, pose: pin.SE3, start: Vector) -> Vector:
    """Return the posture of `iiwa_dnn.solve_pose` from one start."""
    target = iiwa_dnn.Target(pose.translation, pose.rotation)
    return iiwa_dnn.solve_pose(robot, target, start, starts=1).nearest.q


def pink_postures(robot: iiwa_dnn.Robot, pose: pin.SE3, start: Vector) -> Vector:
    """Return where Pink's differential inverse kinematics, iterated, ends up."""
    task = FrameTask(robot.tip, position_cost=1.0, orientation_cost=1.0, lm_damping=1e-3)
    task.set_target(pose)
    limits = [ConfigurationLimit(robot.model, config_limit_gain=1.0)]
    conf = pink.Configuration(robot.model, robot.model.createData(), start)
    for _ in range(ITERATIONS):
        if np.linalg.norm(task.compute_error(conf)) <= 0.5 * TOL:
            break
        try:
            speed = pink.solve_ik(conf, [task], 1.0, "daqp", 1e-12, limits)
        except pink.exceptions.PinkError:
            break
        conf.update(np.clip(conf.integrate(speed, 1.0), robot.q_lower, robot.q_upper))
    found: Vector = conf.q.copy()
    return found


def pinocchio_postures(robot: iiwa_dnn.Robot, pose: pin.SE3, start: Vector) -> Vector:
    """Return where the loop of Pinocchio's example, with whole steps, ends up."""
    model = robot.model
    data = model.createData()
    q = start.copy()
    for _ in range(ITERATIONS):
        pin.framesForwardKinematics(model, data, q)
        missing = data.oMf[robot.tip_id].actInv(pose)
        error = pin.log(missing).vector
        if np.linalg.norm(error) <= 0.5 * TOL:
            break
        jacobian = pin.computeFrameJacobian(model, data, q, robot.tip_id)
        jacobian = -pin.Jlog6(missing.inverse()) @ jacobian
        square = jacobian @ jacobian.T + 1e-12 * np.eye(6)
        step = -jacobian.T @ np.linalg.solve(square, error)
        q = np.clip(pin.integrate(model, q, step), robot.q_lower, robot.q_upper)
    return q


SOLVERS: dict[str, Solver] = {
    "iiwa_dnn": own_postures,
    "Pink, daqp": pink_postures,
    "Pinocchio, clipped": pinocchio_postures,
}


def error_of(robot: iiwa_dnn.Robot, q: Vector, pose: pin.SE3) -> float:
    """Return the larger of the distance [m] and the angle [rad] of the tip from a pose."""
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, q)
    at = data.oMf[robot.tip_id]
    off = np.linalg.norm(at.translation - pose.translation)
    turned = np.linalg.norm(pin.log3(at.rotation.T @ pose.rotation))
    return float(max(off, turned)) if not robot.outside(q) else np.inf


def asked(solver: Solver, robot: iiwa_dnn.Robot, poses: Sequence[pin.SE3], starts: Matrix) -> Ask:
    """Return a solver as `measure` asks it, compiled."""

    def ask(pose: int, start: int) -> tuple[Vector, float]:
        began = time.process_time()
        q = solver(robot, poses[pose], starts[start])
        return q, time.process_time() - began

    ask(0, 0)
    return ask


def placo_postures(
    python: Path,
    robot: iiwa_dnn.Robot,
    poses: Sequence[pin.SE3],
    starts: Matrix,
    stack: ExitStack,
) -> Ask:
    """Return PlaCo's solver in a process of its own, which ends with the stack."""
    folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
    task = {
        "urdf": str(write_urdf(robot, folder)),
        "tip": robot.tip,
        "names": robot.joint_names,
        "lower": robot.q_lower,
        "upper": robot.q_upper,
        "poses": [pose.homogeneous for pose in poses],
        "starts": starts,
        "iterations": ITERATIONS,
        "tol": TOL,
    }
    np.savez(folder / "task.npz", **task)
    driver = Driver(Loop("PlaCo", "placo", "placo_poses"), python, folder / "task.npz")
    stack.callback(driver.close)

    def ask(pose: int, start: int) -> tuple[Vector, float]:
        step = pose * len(starts) + start
        answer = np.array(driver.take(step, step + 1)["q"][0])
        return answer[:-1], float(answer[-1])

    return ask


def measure(robot: iiwa_dnn.Robot, count: int, placo: Path | None = None) -> list[list[str]]:
    """Let each solver look for `count` random poses; returns the table's rows."""
    poses = [
        pin.SE3(at.rotation.copy(), at.position.copy())
        for at in map(partial(iiwa_dnn.Configuration, robot), drawn(robot, count, seed=1))
    ]
    starts = np.vstack([robot.start_posture(), drawn(robot, STARTS - 1, seed=0)])
    rows = []
    with ExitStack() as stack:
        solvers = {name: asked(each, robot, poses, starts) for name, each in SOLVERS.items()}
        if placo is not None:
            solvers["PlaCo"] = placo_postures(placo, robot, poses, starts, stack)
        for name, ask in solvers.items():
            errors = np.full((count, STARTS), np.inf)
            times = np.empty(count)
            for k, pose in enumerate(poses):
                for i in range(STARTS):
                    q, seconds = ask(k, i)
                    if i == 0:
                        times[k] = seconds
                    errors[k, i] = error_of(robot, q, pose)
                    if errors[k, i] <= ROUNDED * TOL:
                        break
            rows.append([robot.name, name, *cells_of(errors, times)])
    return rows


def cells_of(errors: Matrix, times: Vector) -> list[str]:
    """Return the cells of a solver from its errors (count, starts) and CPU times (count,) [s]."""
    found = errors <= ROUNDED * TOL
    cells = [f"{found.any(axis=1).sum():,} of {len(errors):,}", f"{found[:, 0].sum():,}"]
    cells += [f"{errors[found].max(initial=0.0):.1e}", f"{1e3 * np.median(times):.1f}"]
    return [*cells, f"{1e3 * np.percentile(times, 99):.0f}"]


def drawn(robot: iiwa_dnn.Robot, count: int, seed: int) -> Matrix:
    """Draw postures within the limits, (count, n) [rad]."""
    return robot.draw(np.random.default_rng(seed), count)


def bench_poses(arguments: Sequence[str] | None = None, prog: str = "poses") -> int:
    """Look for random poses with every solver and print a table; returns 0."""
    parser = argparse.ArgumentParser(prog, description=bench_poses.__doc__)
    parser.add_argument("--poses", type=int, default=1000, help="number of poses of each arm")
    parser.add_argument("--placo-python", type=Path, help="Python interpreter with PlaCo")
    options = parser.parse_args(arguments)
    robots = map(iiwa_dnn.load_robot, ARMS)
    rows = [row for robot in robots for row in measure(robot, options.poses, options.placo_python)]
    head = ["arm", "solver", "found", "from the first start", "largest error m, rad"]
    print(markdown_table([*head, "median ms", "p99 ms of CPU"], rows))
    return 0

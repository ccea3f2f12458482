"""Layout of the step of an arm, of a shield or a controller, and what can be asked about a step."""

from __future__ import annotations

import math
from collections.abc import Container
from typing import Any, NamedTuple

import numpy as np

from iiwa_dnn.control.chunks import follow_width
from iiwa_dnn.control.news import News, separation_in
from iiwa_dnn.control.requests import REASONS, RequestCost
from iiwa_dnn.control.step_layout import ControlLayout
from iiwa_dnn.naming import active_limits, describe
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import Vector
from iiwa_dnn.robot.kinematics_kernel import model_tables
from iiwa_dnn.robot.obstacles import Obstacle
from iiwa_dnn.schemes.collisions import CollisionAvoidance
from iiwa_dnn.schemes.layout import ProgramLayout
from iiwa_dnn.schemes.scene import Body, scene_views
from iiwa_dnn.schemes.separation import FreeBody, Separation
from iiwa_dnn.schemes.torque import TorqueLimits
from iiwa_dnn.step.asking import margin_of, separation_of, stopping_time_of, torque_of
from iiwa_dnn.step.memory import (
    ArmPlan,
    ArmSettings,
    ArmSizes,
    ArmState,
    motion_of,
    rest_arm,
    see_body,
    see_people,
)
from iiwa_dnn.step.requests import CUT, FASTEST, TWIST, Reason
from iiwa_dnn.step.state import MotionState

ALL_REASONS = range(len(REASONS))

OF_BODIES = (Reason.FRAME_REFUSED, Reason.SEPARATION)
"""Reasons that bodies of bounded speed are."""


class Margin(NamedTuple):
    """Distances of an arm from its limits, or of N arms, (N,).

    Attributes:
        joint: Least distance of a joint from its position limits [rad].
        distance: Least distance of a link from an obstacle or another link, less the one to keep
            [m]; inf if no pair is watched.
        separation: Least distance of a link that joints move from what a body of bounded speed may
            have reached, less the one to keep [m]; inf if there is no body.
        torque: Least part of a torque limit that the command leaves, with the lightest and with the
            heaviest payload; inf without `TorqueLimits`.
    """

    joint: float | Vector
    distance: float | Vector
    separation: float | Vector = np.inf
    torque: float | Vector = np.inf


class ArmLayout(NamedTuple):
    """Layout of the step of a shield's arm or of a controller's.

    Attributes:
        plan: Arrays and settings for kernels.
        step: Layout of the control step.
        memory: Memory of an arm that has not begun, (k,).
        positions: Place of the commanded joint positions in it.
        called: Names of what is called in Python at each step: parts in numpy, obstacles that move
            in a way of their own (`Obstacle.shift`), and a controller's network.
    """

    plan: ArmPlan
    step: ControlLayout
    memory: Vector
    positions: slice
    called: tuple[str, ...]

    def state(self, memory: Vector) -> ArmState:
        """View memories (..., k) of arms as their states."""
        return ArmState.of(memory, *self.plan.sizes)

    def active_limits(self, memory: Vector) -> tuple[str, ...]:
        """Name the reasons, bounds and rows that keep an arm's last command from its request."""
        arm = self.state(memory)
        if self.plan.request >= 0 and not arm.is_clipped:
            return ()
        names = self.step.log_layout.names
        codes, rows = np.split(arm.limiting.astype(int), [arm.positions.size])
        words = map(describe, active_limits(names.settings, codes, rows))
        motion = motion_of(self.plan, arm)
        return (*self.reasons(memory), *words, *names.conditions(motion.q, motion.least))

    def reasons(self, memory: Vector, among: Container[int] = ALL_REASONS) -> tuple[str, ...]:
        """Name each `Reason` of an arm's last step among some; a separation by link and body."""
        return tuple(
            self.separation_words(memory) if code == Reason.SEPARATION else REASONS[code]
            for code in map(int, np.flatnonzero(self.state(memory).reasons))
            if code in among
        )

    def reasons_of_bodies(self, memory: Vector) -> tuple[str, ...]:
        """Name the reasons of an arm's last step that bodies of bounded speed are."""
        return self.reasons(memory, OF_BODIES) if self.plan.separation >= 0 else ()

    def separation_words(self, memory: Vector) -> str:
        """Name the link and the body that slow an arm's last command down, or the body's age."""
        link, number = map(int, separation_of(self.plan, memory)[1:])
        rule = separation_in(self.step.program.parts)
        assert rule is not None
        arm = self.state(memory)
        ages = [FreeBody.of(body).age for body in arm.bodies[: len(rule.bodies)]]
        seen = ages[number] if number < len(ages) else arm.seen.age
        return rule.words(self.step.program.robot, link, number, seen - arm.period)

    def margin(self, memory: Vector) -> Margin:
        """Compute the least distances of joints from their limits, and of pairs from theirs.

        They are those at the joint positions that an arm's last command starts from.
        """
        separation, _, _ = separation_of(self.plan, memory)
        return Margin(*margin_of(self.plan, memory), separation, torque_of(self.plan, memory))

    def stopping_time(self, memory: Vector) -> float:
        """Compute the time of the stopping motion from an arm's last command [s]."""
        return float(stopping_time_of(self.plan, memory))


def see(plan: ArmPlan, memory: Vector, news: News) -> None:
    """Take what was seen of bodies of bounded speed into an arm's memory (k,), overwritten."""
    if news.people is not None:
        see_people(plan, memory, news.people, news.age)
    for number, box in news.bodies.items():
        see_body(plan, memory, number, box, news.age)


def reasons_of(arm: ArmState) -> tuple[str, ...]:
    """Name each `Reason` of an arm's last step."""
    return tuple(REASONS[code] for code in np.flatnonzero(arm.reasons))


def lay_out_arm(
    step: ControlLayout, solver: DNNSolver, settings: ArmSettings, samples: int = 0
) -> ArmLayout:
    """Lay out the step of a shield's arm, if the program has a request, or of a controller's.

    Args:
        step: Layout of the control step.
        solver: The solver that answers its programs.
        settings: Settings of the steps.
        samples: Largest number of samples of a chunk that a shield's arm follows.
    """
    program = step.program
    robot = program.robot
    request = [*program.places_of(RequestCost), -1][0]
    scenes = program.places_of(CollisionAvoidance)
    movers = own_movers(program)
    # What a controller's kernels do not move, its parts do.
    scene = scenes[0] if len(scenes) == 1 and (request >= 0 or not movers) else -1
    avoidance: Any = program.parts[scene] if scene >= 0 else CollisionAvoidance()
    obstacles = avoidance.obstacles
    sizes = _sizes(step, solver, settings, request >= 0)._replace(
        obstacles=len(obstacles), following=follow_width(robot.dof, samples)
    )
    total = np.minimum(robot.dq_max, FASTEST).sum()
    plan = ArmPlan(
        model_tables(robot, program.kinematics.frame_ids, program.needs_inertia),
        step.plan,
        request,
        scene,
        [*program.places_of(Separation), -1][0],
        [*program.places_of(TorqueLimits), -1][0],
        step.log_layout.width,
        float(step.lag),
        float(CUT * max(robot.reach, 1.0) * total),  # above what the joints can do anywhere
        np.array([each.velocity for each in obstacles], dtype=np.float64).reshape(-1, 3),
        settings,
        sizes,
    )
    memory = ArmState.zeros(*sizes)
    if obstacles:
        bodies = scene_views(avoidance.scene(robot).constants).bodies
        centers = [Body.of(body).center for body in bodies[-len(obstacles) :]]
        memory.obstacles = np.array(centers)
    rest_arm(plan, memory.numbers, np.zeros(0))
    positions = ArmState.columns(*sizes)["positions"]
    called: list[object] = [program.parts[k] for k in program.refreshed if k != scene]
    called += movers if scene >= 0 else []
    called += [solver.network] * (request < 0 and not step.has_network)
    names = tuple(type(part).__name__ for part in called)
    return ArmLayout(plan, step, memory.numbers, positions, names)


def _sizes(step: ControlLayout, solver: DNNSolver, settings: ArmSettings, asks: bool) -> ArmSizes:
    """Return the sizes of the state of an arm, which has requests or not, and no obstacles."""
    program = step.program
    dof = program.robot.dof
    n, m, _ = program.sizes
    fallback = step.plan.fallback.size
    late = 1 + 2 * math.ceil(settings.delay / settings.dt)  # two in a row outlast a period
    return ArmSizes(
        n=dof,
        request=max(dof, TWIST) * asks,
        motion=MotionState.width(dof, len(program.pairs)),
        network=solver.state_size(program.sizes) if step.has_network else 0,
        fallback=fallback,
        twist_fallback=fallback * asks,
        obstacles=0,
        limiting=n + m,
        sent=(1 + dof) * late * (settings.delay > 0.0),
        bodies=sum(len(each.names) for each in program.parts if isinstance(each, Separation)),
        following=0,
    )


def own_movers(program: ProgramLayout) -> list[Any]:
    """Return the obstacles of a program that do not move at a constant velocity."""
    scenes: list[Any] = [program.parts[k] for k in program.places_of(CollisionAvoidance)]
    obstacles = [each for scene in scenes for each in scene.obstacles]
    return [each for each in obstacles if type(each).shift is not Obstacle.shift]

"""The physical arm: MuJoCo steps it under torques; the torque loop sees its encoders only."""

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.program import Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.mujoco_model import (
    TIP_SITE,
    JointDynamics,
    compile_model,
    import_mujoco,
    torque_limits,
)
from iiwa_dnn.simulation.disturbances import Disturbances, Encoder
from iiwa_dnn.simulation.plants.base import Plant, PlantState
from iiwa_dnn.simulation.plants.torque_control import TorqueController, TorqueGains

_COARSEST = 1e-3  # the longest physics step that is accepted [s]


class MujocoPlant(Plant):
    """An arm with mass, motors and disturbances, whose torque loop follows velocity commands.

    Args:
        disturbances: Differences between the arm and the controller's idea of it; None for none.
        gains: Stiffness of the torque loop; None takes the defaults.
        dynamics: Joint damping and rotor inertia, of the arm and of its nominal model; None takes
            the estimates.
        timestep: Physics step [s], at most 1e-3; a whole number of them makes the control period.

    Raises:
        InvalidInputError: If the physics step is out of range.
    """

    def __init__(
        self,
        disturbances: Disturbances | None = None,
        gains: TorqueGains | None = None,
        dynamics: JointDynamics | None = None,
        timestep: float = 2.5e-4,
    ) -> None:
        checks.positive("physics_dt", timestep)
        if timestep > _COARSEST:
            problem = f"must be at most {_COARSEST:g} s, not {timestep:g}"
            raise InvalidInputError("physics_dt", problem, timestep)
        self.timestep = timestep
        self.disturbances = Disturbances() if disturbances is None else disturbances
        checks.instance("disturbances", self.disturbances, Disturbances)
        self.gains = TorqueGains() if gains is None else gains
        self.dynamics = JointDynamics() if dynamics is None else dynamics

    def start(self, robot: Robot, q0: Vector, dt: float, seed: int) -> Mapping[str, Any]:
        """Build the arm, with masses and encoder noise drawn from the seed, and put it at rest.

        Returns:
            Torque limits, physics and torque loop, for the settings of a record.

        Raises:
            MissingDependencyError: If MuJoCo is not installed.
            InvalidInputError: If the physics step does not divide the control period, or MuJoCo
                cannot take the robot (`iiwa_dnn.robot.mujoco_model`).
        """
        substeps = round(dt / self.timestep)
        if substeps < 1 or abs(substeps * self.timestep - dt) > 1e-9 * dt:
            problem = f"must divide the control period of {dt:g} s, {self.timestep:g} s does not"
            raise InvalidInputError("physics_dt", problem, self.timestep)
        self._mj = import_mujoco()
        if self._mj.get_mju_user_warning() is None:  # else they go into the working folder
            self._mj.set_mju_user_warning(lambda message: None)
        timestep = dt / substeps
        wrong = self.disturbances
        limit = torque_limits(robot)
        friction = np.where(np.isfinite(limit), wrong.friction * limit, 0.0)
        factors = wrong.mass_factors(robot.dof, seed)
        self._model = compile_model(robot, timestep, self.dynamics, friction, factors)
        self._data = self._mj.MjData(self._model)
        self._data.qpos[:] = q0
        self._mj.mj_forward(self._model, self._data)
        self._encoder = Encoder(wrong.encoder_noise, wrong.encoder_bits, seed)
        self._torques = TorqueController(robot, dt, timestep, self.gains, self.dynamics, q0)
        self._late: list[Vector] = [np.zeros(robot.dof)] * wrong.delay_periods
        self._reading: Vector | None = None
        return self._settings()

    def read(self) -> Vector:
        """Measure the joint angles [rad], (n,); every call is a new reading."""
        self._reading = self._encoder(self._data.qpos)
        return self._reading.copy()

    def move(self, command: Vector) -> PlantState:
        """Follow a velocity command (n,) [rad/s], late by the delay, for one control period.

        The first physics step goes by the last `read`, if there was one since the last move. A
        state that is too large, at which MuJoCo resets the arm, is a fault.
        """
        self._late.append(np.array(command))
        self._torques.command(self._late.pop(0))
        largest: Vector = np.zeros_like(command)
        for _ in range(self._torques.substeps):
            reading = self._encoder(self._data.qpos) if self._reading is None else self._reading
            self._reading = None
            torque = self._torques.torque(reading)
            self._step(torque)
            larger = np.abs(torque) > np.abs(largest)
            largest[larger] = torque[larger]
        kinds = self._mj.mjtWarning
        bad = (kinds.mjWARN_BADQPOS, kinds.mjWARN_BADQVEL, kinds.mjWARN_BADQACC)
        in_arm = any(self._data.warning[int(kind)].number > 0 for kind in bad)
        fault = "the physics diverged" if in_arm or self._torques.diverged else None
        return PlantState(np.array(self._data.qpos), largest, fault)

    def _step(self, torque: Vector) -> None:
        """Hold joint torques (n,) [N m] for one physics step."""
        data = self._data
        data.ctrl[:] = torque
        push = self.disturbances.push
        if push is not None:
            data.qfrc_applied[:] = 0.0
            # The middle of the step, so that rounding of the time cannot cost or add a step.
            middle = data.time + 0.5 * self._model.opt.timestep
            if push.start <= middle < push.start + push.duration:
                tip = self._model.site(TIP_SITE)
                point = data.site_xpos[tip.id]
                body = int(tip.bodyid[0])
                force = np.array(push.force)
                out = data.qfrc_applied
                self._mj.mj_applyFT(self._model, data, force, np.zeros(3), point, body, out)
        self._mj.mj_step(self._model, data)

    def _settings(self) -> dict[str, Any]:
        model = self._model
        physics = {
            "engine": f"MuJoCo {self._mj.__version__}",
            "timestep": model.opt.timestep,
            "damping": model.dof_damping.reshape(model.nv, -1)[:, 0].tolist(),
            "armature": model.dof_armature.tolist(),
            "friction": model.dof_frictionloss.tolist(),
            "disturbances": asdict(self.disturbances),
            "torque_loop": asdict(self.gains),
        }
        return {"torque_max": self._torques.limit, "physics": physics}

"""The physical arm: MuJoCo steps it under torques; only its encoders can be read."""

from __future__ import annotations

from typing import Any

import numpy as np

from iiwa_dnn.qp.program import Vector
from iiwa_dnn.robot.mujoco_model import (
    TIP_SITE,
    JointDynamics,
    compile_model,
    torque_limits,
)
from iiwa_dnn.robot.offscreen import import_mujoco
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.simulation.disturbances import Disturbances, Encoder


class Plant:
    """A disturbed arm in MuJoCo.

    Attributes:
        timestep: Physics step [s].
        disturbances: How it differs from the nominal model.
    """

    def __init__(
        self,
        robot: Robot,
        timestep: float,
        disturbances: Disturbances,
        seed: int,
        dynamics: JointDynamics | None = None,
    ) -> None:
        """Compile the arm; `reset` comes before the first step.

        Raises:
            MissingDependencyError: If MuJoCo is not installed.
            InvalidInputError: If MuJoCo cannot take the robot (`iiwa_dnn.robot.mujoco_model`).
        """
        self._mj = mj = import_mujoco()
        if mj.get_mju_user_warning() is None:
            # Else MuJoCo writes its warnings to a file in the working folder; `diverged` has them.
            mj.set_mju_user_warning(lambda message: None)
        limit = torque_limits(robot)
        self._model = compile_model(
            robot,
            timestep,
            dynamics,
            friction=np.where(np.isfinite(limit), disturbances.friction * limit, 0.0),
            mass_factors=disturbances.mass_factors(robot.dof, seed),
        )
        self._data = self._mj.MjData(self._model)
        self._site = self._model.site(TIP_SITE).id
        self._tip_body = int(self._model.site_bodyid[self._site])
        self._seed = seed
        self.timestep, self.disturbances = timestep, disturbances

    def reset(self, q: Vector) -> None:
        """Put the arm at rest at joint angles `q` (n,) [rad] and start its noise anew."""
        wrong = self.disturbances
        self._encoder = Encoder(wrong.encoder_noise, wrong.encoder_step, self._seed)
        self._mj.mj_resetData(self._model, self._data)
        self._data.qpos[:] = q
        self._mj.mj_forward(self._model, self._data)

    @property
    def q(self) -> Vector:
        """True joint angles [rad], (n,), a copy."""
        copy: Vector = self._data.qpos.copy()
        return copy

    @property
    def diverged(self) -> bool:
        """Whether MuJoCo has met a state that is not a number or too large, and reset the arm."""
        warnings = self._data.warning
        kinds = self._mj.mjtWarning
        bad = (kinds.mjWARN_BADQPOS, kinds.mjWARN_BADQVEL, kinds.mjWARN_BADQACC)
        return any(warnings[int(kind)].number > 0 for kind in bad)

    def read_encoders(self) -> Vector:
        """Measured joint angles [rad], (n,); every call is a new reading."""
        return self._encoder(self._data.qpos)

    def step(self, torque: Vector) -> None:
        """Hold joint torques (n,) [N m] for one physics step."""
        data = self._data
        data.ctrl[:] = torque
        push = self.disturbances.push
        if push is not None:
            data.qfrc_applied[:] = 0.0
            # The middle of the step, so that rounding of the time cannot cost or add a step.
            if push.start <= data.time + 0.5 * self.timestep < push.end:
                point, force = data.site_xpos[self._site], np.array(push.force)
                self._mj.mj_applyFT(
                    self._model, data, force, np.zeros(3), point, self._tip_body, data.qfrc_applied
                )
        self._mj.mj_step(self._model, data)

    def settings(self) -> dict[str, Any]:
        """What the record says of the physics."""
        return {
            "engine": f"MuJoCo {self._mj.__version__}",
            "timestep": self.timestep,
            "damping": self._model.dof_damping.reshape(self._model.nv, -1)[:, 0].tolist(),
            "armature": self._model.dof_armature.tolist(),
            "friction": self._model.dof_frictionloss.tolist(),
            "disturbances": self.disturbances.settings(),
        }

"""Robots from a table of Denavit-Hartenberg parameters, as papers and handbooks print them.

Sources: J. Denavit, R. S. Hartenberg, "A kinematic notation for lower-pair mechanisms based on
matrices", ASME Journal of Applied Mechanics 22 (1955), for the standard convention; J. J. Craig,
"Introduction to Robotics", chapter 3, for the modified one.
"""

from collections.abc import Iterable
from typing import Literal

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.robot.loading import load_robot
from iiwa_dnn.robot.robot import Robot


def robot_from_dh(
    table: ArrayLike,
    *,
    convention: Literal["standard", "modified"] = "standard",
    prismatic: Iterable[int] = (),
    lower: ArrayLike = -np.inf,
    upper: ArrayLike = np.inf,
    velocity: ArrayLike = np.inf,
    name: str = "arm",
) -> Robot:
    r"""Build a robot from one row [a, alpha, d, theta] a joint.

    A revolute joint adds its position to theta, a prismatic one to d. Row i leads from frame i - 1
    to frame i by

    .. math::

        R_z(\theta)\,T_z(d)\,T_x(a)\,R_x(\alpha) \;\text{(standard)}, \qquad
        R_x(\alpha)\,T_x(a)\,R_z(\theta)\,T_z(d) \;\text{(modified)}.

    The frames are ``base``, ``link_1`` ... ``link_n``, the last one the tip; the joints are
    ``joint_1`` ... ``joint_n``. The links have no mass: physics and inertia costs need a URDF.

    Args:
        table: a [m], alpha [rad], d [m] and theta, the joint's offset [rad], (n, 4); in the
            modified convention a and alpha are those that come before the joint.
        convention: ``"standard"`` or ``"modified"``.
        prismatic: Numbers of the prismatic joints, from 1.
        lower: Lower joint position limits [rad or m], one number or (n,); -inf for none.
        upper: Upper joint position limits [rad or m], one number or (n,); inf for none.
        velocity: Joint velocity limits [rad/s or m/s], one number or (n,); inf for none.
        name: Name of the robot.

    Raises:
        InvalidInputError: The table is not finite or has other than four columns, a number of
            `prismatic` is no joint's, or a limit is not acceptable.
    """
    checks.one_of("convention", convention, ("standard", "modified"))
    rows = checks.finite_array("table", table, (-1, 4))
    slides = set(prismatic)
    if not slides <= set(range(1, len(rows) + 1)):
        problem = f"must be numbers from 1 to {len(rows)}, not {sorted(slides)}"
        raise InvalidInputError("prismatic", problem, prismatic)
    model = pin.Model()
    model.name = name
    model.addFrame(pin.Frame("base", 0, pin.SE3.Identity(), pin.FrameType.BODY))
    joint = 0
    behind = pin.SE3.Identity()
    for i, (a, alpha, d, theta) in enumerate(rows, 1):
        across = pin.SE3(pin.utils.rotate("x", alpha), np.array([a, 0.0, 0.0]))
        along = pin.SE3(pin.utils.rotate("z", theta), np.array([0.0, 0.0, d]))
        # The joint moves about or along z, like `along`, and may come after it.
        if convention == "standard":
            before = behind * along
            behind = across
        else:
            before = across * along
        kind = pin.JointModelPZ() if i in slides else pin.JointModelRZ()
        joint = model.addJoint(joint, kind, before, f"joint_{i}")
        model.addJointFrame(joint)
        model.addFrame(pin.Frame(f"link_{i}", joint, behind, pin.FrameType.BODY))
    return load_robot(model, f"link_{len(rows)}").with_limits(lower, upper, velocity)

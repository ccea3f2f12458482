"""Arms that can be loaded by name: URDF file, tip frames, start posture, rates and motors.

Files that are not in the package come with ``example-robot-data`` (extra ``robots``), which is data
only: the URDFs as their makers publish them.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from iiwa_dnn.errors import MissingDependencyError

_PACKAGE = "example-robot-data"
_FOLDER = "cmeel.prefix/share/example-robot-data/robots"


def robots_folder() -> Path:
    """Find the folder of the robots: in an installed package, or beside it in the repository."""
    here = Path(__file__).resolve().parents[1]
    inside = here / "robots"
    return inside if inside.is_dir() else here.parent / "robots"


@dataclass(frozen=True)
class Arm:
    """An arm known by name: its URDF, and facts that no URDF holds.

    Attributes:
        file: The URDF's path in the robots' folder of this package or of ``example-robot-data``.
        tips: Frames at the ends; the first follows references. Joints that move none are locked.
        start: Posture away from limits and singular postures [rad], (n,).
        rates: Acceleration [rad/s^2] and jerk [rad/s^3] limits, (2, n); () for none.
        effort: Torque limits that the maker states [N m], (n,), in place of the file's.
        armature: Rotor inertias seen through the gears [kg m^2], (n,); () if none are published.
        friction: Bounds on the torque that friction takes [N m], (n,); () if none are known.
    """

    file: str
    tips: tuple[str, ...]
    start: tuple[float, ...]
    rates: tuple[tuple[float, ...], ...] = ()
    effort: tuple[float, ...] = ()
    armature: tuple[float, ...] = ()
    friction: tuple[float, ...] = ()

    @property
    def path(self) -> Path:
        """The URDF file.

        Raises:
            MissingDependencyError: The package of the file is not installed.
        """
        own = robots_folder() / self.file
        if own.is_file():
            return own
        from importlib.metadata import PackageNotFoundError, distribution  # a slow import

        try:
            return Path(str(distribution(_PACKAGE).locate_file(_FOLDER))) / self.file
        except PackageNotFoundError as error:
            raise MissingDependencyError(_PACKAGE, "pip install 'iiwa-dnn[robots]'") from error


_TALOS = "talos_data/robots/talos_reduced.urdf"
_BAXTER = "baxter_description/urdf/baxter.urdf"
# Stretched farther out, Baxter's motors do not hold its arms: a real one has springs.
_BENT = (0.0, -1.0, 0.0, 1.9, 0.0, 0.67, 0.0)
_WRIST = (0.0, 0.0, 0.0)
_IIWA7 = (8.65, 5.44, 5.69, 11.01, 11.78, 13.76, 13.17)
_IIWA7_EFFORT = (176.0, 176.0, 110.0, 110.0, 110.0, 40.0, 40.0)
_FRANKA_EFFORT = (87.0,) * 4 + (12.0,) * 3
_FRANKA_ARMATURE = (0.605721456,) * 2 + (0.462474144,) * 2 + (0.205544064,) * 3
_UR = (
    0.8699832445515518,
    -0.8770505783483138,
    1.8744372978808101,
    3.6254130429258336,
    1.3989536049048539,
    1.1344362167697817,
)

ARMS = {
    "fr3": Arm(
        "fr3/fr3.urdf",
        ("link8",),
        (0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785),
        ((9.999,) * 7, (4999.999,) * 7),
        _FRANKA_EFFORT,
        _FRANKA_ARMATURE,
    ),
    "iiwa7": Arm(
        "iiwa7/iiwa7.urdf",
        ("iiwa7_flange",),
        (-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0),  # the paper's theta(0), section V
        (_IIWA7, (np.inf,) * 7),
        _IIWA7_EFFORT,
    ),
    "iiwa7_dual": Arm(
        "iiwa7_dual/iiwa7_dual.urdf",
        ("left_iiwa7_flange", "right_iiwa7_flange"),
        (0.0, 0.6, 0.0, -1.4, 0.0, 1.1, 0.0) * 2,
        (_IIWA7 * 2, (np.inf,) * 14),
        _IIWA7_EFFORT * 2,
    ),
    "baxter_left": Arm(_BAXTER, ("left_gripper",), _BENT),
    "baxter_right": Arm(_BAXTER, ("right_gripper",), _BENT),
    "kinova": Arm(
        "kinova_description/robots/kinova.urdf",
        ("j2s6s200_end_effector",),
        (
            3.222700497924974,
            4.445022339799348,
            1.5051939052441634,
            2.7417816865589515,
            4.653311456404989,
            3.4472835393894563,
        ),
    ),
    "panda": Arm(
        "panda_description/urdf/panda.urdf",
        ("panda_hand_tcp",),
        (0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785),
        (
            (15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0),
            (7500.0, 3750.0, 5000.0, 6250.0, 7500.0, 10000.0, 10000.0),
        ),
        _FRANKA_EFFORT,
        _FRANKA_ARMATURE,
        (0.31, 0.49, 0.4, 0.71, 0.47, 0.18, 0.29),
    ),
    "so101": Arm(
        "so_arm_description/urdf/so101.urdf", ("gripper_frame_link",), (0.0, -0.6, 0.6, 0.8, 0.0)
    ),
    "talos_left": Arm(
        _TALOS,
        ("gripper_left_base_link",),
        (0.0, 0.261799387799, -0.5235987755960001, 1.439896632895, 0.0, -1.178097245095, *_WRIST),
    ),
    "talos_left_arm": Arm(
        "talos_data/robots/talos_left_arm.urdf",
        ("gripper_left_base_link",),
        (1.3, -0.9, -1.8, 0.2, -0.3, 0.1),
    ),
    "talos_right": Arm(
        _TALOS,
        ("gripper_right_base_link",),
        (0.0, 0.261799387799, 0.5235987755959999, -1.439896632895, 0.0, -1.178097245095, *_WRIST),
    ),
    "tiago": Arm(
        "tiago_description/robots/tiago.urdf",
        ("arm_tool_link",),
        (0.1, 1.8, -0.7, -0.9, 0.8, 0.7, -0.6, -0.6),
    ),
    "ur3": Arm(
        "ur_description/urdf/ur3_robot.urdf",
        ("tool0",),
        _UR,
        effort=(56.0, 56.0, 28.0, 12.0, 12.0, 12.0),
    ),
    "ur5": Arm(
        "ur_description/urdf/ur5_robot.urdf",
        ("tool0",),
        (0.0, -1.2, 1.6, -1.97, -1.57, 0.0),
        effort=(150.0, 150.0, 150.0, 28.0, 28.0, 28.0),
    ),
    "ur10": Arm(
        "ur_description/urdf/ur10_robot.urdf",
        ("tool0",),
        _UR,
        effort=(330.0, 330.0, 150.0, 56.0, 56.0, 56.0),
    ),
    "xarm7": Arm(
        "xarm_description/urdf/xarm7.urdf", ("link_eef",), (0.0, -0.25, 0.0, 0.9, 0.0, 1.15, 0.0)
    ),
    "z1": Arm(
        "z1_description/urdf/z1.urdf",
        ("gripperStator",),
        (0.0, 1.4835298641951802, -1.4398966328953218, 0.0, 0.0, 0.0),
    ),
}
"""Arms by name.

Hands. fr3, iiwa7, iiwa7_dual, ur3, ur5, ur10 and xarm7 end at their flanges, without one. The other
files have a hand or gripper, the panda's with its fingers closed, as joints that are held still.

Sources of the rates. iiwa7: KUKA publishes none. These accelerations are `drake:acceleration` of
iiwa_description/sdf/iiwa7_no_collision.sdf in github.com/RobotLocomotion/models; its README derives
them from measured ones of an iiwa 14 (C. Larsen, master's thesis, Chalmers 2019, table 4) by the
ratio of torque limits times inverse mass matrices. panda: kMaxJointAcceleration and kMaxJointJerk
of include/franka/rate_limiting.h in libfranka 0.9.2, the last one for that arm, plus its kLimitEps.
fr3: the same of libfranka 0.21, 10 rad/s^2 and 5000 rad/s^3 less its kLimitEps.

Sources of the motors. iiwa7: KUKA LBR iiwa technical data, page 1, by iiwa_description/README.md in
github.com/RobotLocomotion/models; KUKA publishes no rotor inertia (that README takes those of a DLR
LWR II). fr3, panda: efforts of robots/fr3/joint_limits.yaml in github.com/frankarobotics/
franka_description; reflected inertias that Franka provided for the fr3, by manipulation/models/
franka_description/README.md of Drake, which takes them for the panda, too; friction of a panda: the
largest of the curves of C. Gaz et al., "Dynamic identification of the Franka Emika Panda robot with
retrieval of feasible parameters using penalty-based optimization", IEEE Robotics and Automation
Letters 4(4), 2019 (get_FrictionTorque.m in github.com/marcocognetti/FrankaEmikaPandaDynModel),
rounded up. ur3, ur5, ur10: Universal Robots' article "Max. joint torques" of 2020-06-09, by
config/*/joint_limits.yaml in github.com/UniversalRobots/Universal_Robots_ROS2_Description.
"""

WRONG_EFFORTS = {
    "so101": (10.0, "its file gives each joint 10 N m, three times the stall torque of its servos"),
    "ur3": (330.0, "its file gives the torques of a ur10"),
}
"""Efforts of files that are known to be wrong: that of the first joint [N m], and why."""

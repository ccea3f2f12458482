"""Names in words of a program's limits, and of the conditions that a step does not keep yet."""

from iiwa_dnn.qp import Vector
from iiwa_dnn.schemes.collisions import MEET
from iiwa_dnn.schemes.joint_limits import is_of_joints
from iiwa_dnn.schemes.layout import ProgramLayout
from iiwa_dnn.schemes.tasks import JointCouplingTask

OFF = 1e-6
"""Error of a relation between joints above which it is reported [rad]."""


class LimitNames:
    """Names of the bounds and inequality rows of a program.

    Attributes:
        settings: Settings that `naming.active_limits` reads: ``rows`` has for each inequality row
            its part, its number in the part from 1, and its name if any; ``pairs`` has the names of
            the watched pairs; ``bounding`` has the class names of the limits, whose kinds are
            `LimitKind.OTHER`, `LimitKind.OTHER` + 1, ....
    """

    def __init__(self, program: ProgramLayout) -> None:
        """Name the limits of a program."""
        self._program = program
        rows: list[dict[str, object]] = []
        for limit in program.limits:
            names = limit.row_names(program.robot)
            about = [{"about": name} for name in names] or [{}] * limit.row_count(program.robot)
            part: dict[str, object] = {"part": type(limit).__name__}
            rows += [part | {"row": number} | name for number, name in enumerate(about, 1)]
        others = [limit for limit in program.limits if not is_of_joints(limit)]
        self.settings = {
            "rows": rows,
            "pairs": [name for name, _ in program.pairs],
            "bounding": [type(limit).__name__ for limit in others],
        }

    def conditions(self, q: Vector, least: Vector) -> tuple[str, ...]:
        """Describe pairs that began too near, and relations between joints that are not fulfilled.

        Args:
            q: Joint positions [rad], (n,).
            least: Distance that each watched pair has to keep [m], (pairs,); one that is not the
                scheme's is described.

        Returns:
            A text for each.
        """
        near = [
            f"{names} meet, and no direction separates them"
            if kept == MEET
            else f"{names} began nearer than {promised:g} m, and keep {kept:.3g} m"
            for (names, promised), kept in zip(self._program.pairs, least, strict=True)
            if kept != promised
        ]
        found = [
            (task.coefficients, task.error(self._program.robot, q))
            for task in self._program.tasks
            if isinstance(task, JointCouplingTask)
        ]
        off = [
            f"{' and '.join(joints)}: {error:.3g} rad off their JointCouplingTask"
            for joints, error in found
            if abs(error) > OFF
        ]
        return (*near, *off)

"""Names in words of the limits of a program, and of its promises that wait."""

from iiwa_dnn.qp import Vector
from iiwa_dnn.schemes.collisions import MEET
from iiwa_dnn.schemes.layout import ProgramLayout
from iiwa_dnn.schemes.rate_limits import RateLimits
from iiwa_dnn.schemes.tasks import JointCouplingTask

OFF = 1e-6
"""Error of a relation of joints from which on it is reported [rad]."""


class LimitNames:
    """Names of the bounds and inequality rows of a program.

    Attributes:
        settings: Settings that `naming.active_limits` reads: ``rows`` has for each inequality row
            its part, its number in it from 1, and its name if any, ``bounding`` the limits in the
            order of their codes (`LimitKind.OTHER`).
    """

    def __init__(self, program: ProgramLayout) -> None:
        """Take the limits of a program."""
        self._program = program
        rows: list[dict[str, object]] = []
        for limit in program.limits:
            names = limit.row_names(program.robot)
            about = [{"about": name} for name in names] or [{}] * limit.row_count(program.robot)
            part: dict[str, object] = {"part": type(limit).__name__}
            rows += [part | {"row": number} | name for number, name in enumerate(about, 1)]
        others = [limit for limit in program.limits if not isinstance(limit, RateLimits)]
        self.settings = {"rows": rows, "bounding": [type(limit).__name__ for limit in others]}

    def conditions(self, q: Vector, least: Vector) -> tuple[str, ...]:
        """State which promises wait for the arm to come nearer to them.

        They are pairs that keep another distance than the scheme's, `least` (pairs,) [m], and
        relations of joints that the positions q (n,) [rad] do not fulfil.
        """
        near = [
            f"{names} meet, and no direction separates them"
            if kept == MEET
            else f"{names} began nearer than {promised:g} m, and keep {kept:.3g} m"
            for (names, promised), kept in zip(self._program.pairs, least, strict=True)
            if kept != promised
        ]
        found = [
            (task.coefficients, task.missing(self._program.robot, q))
            for task in self._program.tasks
            if isinstance(task, JointCouplingTask)
        ]
        off = [
            f"{' and '.join(joints)}: {missing:.3g} rad off their JointCouplingTask"
            for joints, missing in found
            if abs(missing) > OFF
        ]
        return (*near, *off)

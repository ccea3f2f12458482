"""The decision of one control step, and the evidence for it."""

import numpy as np

from iiwa_dnn.control.answers import Answers
from iiwa_dnn.control.policies import Action, Resolution
from iiwa_dnn.qp import QP, Solution, Vector


class Command:
    """Decision of one control step.

    Attributes:
        dq: Joint velocity [rad/s], (n,), within the limits.
    """

    __slots__ = ("_answers", "_index", "dq")

    def __init__(self, answers: Answers, index: int, dq: Vector) -> None:
        self._answers, self._index, self.dq = answers, index, dq

    @property
    def resolution(self) -> Resolution | None:
        """Decision of the policy where the network had no answer; else None."""
        return self._answers.resolved.get(self._index)

    @property
    def qp(self) -> QP:
        """The program that was answered."""
        return self._answers.qp(self._index)

    @property
    def solution(self) -> Solution:
        """The answer: the network's unless there is a resolution."""
        return self._answers.solution(self._index)

    @property
    def action(self) -> Action:
        """The action taken; ``Action.NONE`` where the network's answer was taken."""
        resolution = self.resolution
        return Action.NONE if resolution is None else resolution.action

    @property
    def ok(self) -> bool:
        """True if the command does all that the tasks ask: solved, by the network or a fallback."""
        asked = self.action in (Action.NONE, Action.FALLBACK)
        return asked and self._index not in self._answers.unsolved

    def __repr__(self) -> str:
        dq, words = np.array2string(self.dq, precision=4, separator=", "), _WORDS[self.action]
        if self.action is Action.NONE and not self.ok:
            words = "not settled"
        if (found := self.resolution) is not None:
            sides = zip(("lower", "upper"), (found.sides < 0, found.sides > 0), strict=True)
            against = [f"joint {i + 1} {side} bound" for side, at in sides for i in at.nonzero()[0]]
            against += [f"inequality row {i + 1}" for i in found.rows.nonzero()[0]]
            words += f", against {', '.join(against)}" if against else ""
        return f"<Command dq = {dq} rad/s, {words}; ok = {self.ok}>"


_WORDS = {
    Action.NONE: "solved",
    Action.FALLBACK: "solved by the reference solver",
    Action.SLOW: "no solution: slower along the path",
    Action.RELAX: "no solution: as near to the task as the limits allow",
    Action.STOP: "no solution: stopped",
}

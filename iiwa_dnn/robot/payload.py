"""Payloads: a body of uncertain mass that a frame of a robot carries."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError


class Payload(NamedTuple):
    """A body whose mass is anywhere in a range; its moments of inertia are in proportion to it.

    Attributes:
        frame: Name of the frame that carries it.
        mass: Smallest and largest mass [kg], (2,).
        center: Ends of the box in the frame that its centre of mass is in [m], (2, 3).
        inertia: Inertia about the centre along the frame's axes for each kilogram [m^2], (3, 3).
    """

    frame: str
    mass: checks.Array
    center: checks.Array
    inertia: checks.Array

    @property
    def words(self) -> str:
        """The mass or the range of masses in words."""
        least, most = self.mass
        return f"{most:g} kg" if least == most else f"{least:g} to {most:g} kg"

    def settings(self) -> dict[str, Any]:
        """Return frame, mass, centre and inertia per kilogram as values that JSON can hold."""
        arrays = {"mass": self.mass, "center": self.center, "inertia": self.inertia}
        return {"frame": self.frame} | {name: own.tolist() for name, own in arrays.items()}


def make_payload(
    frame: str, mass: ArrayLike, center: ArrayLike, inertia: ArrayLike | None
) -> Payload:
    """Make the payload of a frame; the arguments are those of `Robot.with_payload`.

    Raises:
        InvalidInputError: A mass is negative or the range is none, an array has a wrong shape, or
            the inertia is none that a body can have.
    """
    least, most = checks.finite_array("mass", np.broadcast_to(mass, np.shape(mass) or 2), (2,))
    if not 0.0 <= least <= most:
        raise InvalidInputError("mass", "must be a mass, or the ends of a range of masses", mass)
    about = checks.finite_array("inertia", np.zeros((3, 3)) if inertia is None else inertia, (3, 3))
    moments = np.linalg.eigvalsh(about)
    forgiven = 1e-9 * np.abs(about).max()
    if np.abs(about - about.T).max() > forgiven or moments[2] > moments[0] + moments[1] + forgiven:
        raise InvalidInputError("inertia", "is none that a body can have", inertia)
    own = np.array([least, most])
    ends = checks.finite_array("center", center, (2, 3) if np.ndim(center) > 1 else (3,))
    where = np.broadcast_to(ends, (2, 3))
    if (where[0] > where[-1]).any():
        raise InvalidInputError("center", "must be a point, or the ends of a box", center)
    about = about / (most or 1.0)
    return Payload(frame, *(checks.read_only(np.array(each)) for each in (own, where, about)))

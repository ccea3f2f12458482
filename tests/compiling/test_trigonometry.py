"""Sine and cosine of the kernels, against series in whole numbers of 340 digits."""

import math
from decimal import Decimal, localcontext

import numpy as np
import pytest

import iiwa_dnn
from iiwa_dnn.compiling.library import source_of
from iiwa_dnn.compiling.trigonometry import FARTHEST, LARGEST, sin, sin_cos


def atan_inverse(x: int, one: int) -> int:
    """Compute one * atan(1 / x) by its series."""
    power = total = one // x
    for k in range(3, 1000, 2):
        power //= -x * x
        total += power // k
    return total


ONE = 10**340
PI = 4 * (4 * atan_inverse(5, ONE) - atan_inverse(239, ONE))  # Machin, 1706


def exact(x: float) -> tuple[Decimal, Decimal]:
    """Compute sine and cosine of a double, with 300 digits after the point."""
    top, bottom = x.as_integer_ratio()
    quarters, rest = divmod(4 * ONE * top + bottom * PI, 2 * PI * bottom)
    angle = (rest - PI * bottom) // (4 * bottom)  # in -pi/4 .. pi/4
    values = []
    for first in (angle, ONE):
        term = total = first
        k = 2 if first is ONE else 3
        while term:
            term = -term * angle * angle // (ONE * ONE * k * (k - 1))
            total += term
            k += 2
        values.append(total)
    sine, cosine = values
    turned = [(sine, cosine), (cosine, -sine), (-sine, -cosine), (-cosine, sine)][quarters % 4]
    with localcontext() as context:
        context.prec = 400
        return Decimal(turned[0]) / ONE, Decimal(turned[1]) / ONE


def units_off(found: float, true: Decimal) -> float:
    """Return the error in units of the last place of the true value."""
    with localcontext() as context:
        context.prec = 400
        return float(abs(Decimal(found) - true) / Decimal(math.ulp(float(true))))


def angles() -> list[float]:
    """Angles of every size below 2^20 rad, and those nearest to multiples of pi/2."""
    rng = np.random.default_rng(0)
    spread = [*rng.uniform(-4.0, 4.0, 300), *rng.uniform(-LARGEST, LARGEST, 100)]
    sizes = np.ldexp(rng.uniform(0.5, 1.0, 100), rng.integers(-60, 20, 100))
    quarters = [k * 0.5 * math.pi for k in (1, 2, 3, 5, 1024, 333333, 667543)]
    nearest = [np.nextafter(x, x * side) for x in quarters for side in (0.0, 1.0, 2.0)]
    return [float(x) for x in [*spread, *sizes, *nearest, 0.0, 1e-300, LARGEST - 1e-10]]


def test_both_are_within_eight_tenths_of_a_unit_in_the_last_place() -> None:
    worst = 0.0
    for x in angles():
        for found, true in zip(sin_cos(x), exact(x), strict=True):
            worst = max(worst, units_off(found, true))
    assert worst < 0.8


def test_the_series_of_this_file_agree_with_the_mathematics() -> None:
    with localcontext() as context:
        context.prec = 400
        for x in (0.3, -2.0, 1e5, 22.0):
            sine, cosine = exact(x)
            assert abs(sine * sine + cosine * cosine - 1) < Decimal(10) ** -150
            assert (float(sine), float(cosine)) == pytest.approx((math.sin(x), math.cos(x)))


def test_beyond_the_domain_the_error_is_one_of_the_angle() -> None:
    for x in np.random.default_rng(1).uniform(LARGEST, 1e3 * LARGEST, 200).tolist():
        for found, true in zip(sin_cos(-x), exact(-x), strict=True):
            assert abs(found - float(true)) <= math.ulp(x)
    for x in (FARTHEST, -1e300):
        assert sin_cos(x) == (0.0, 1.0)
    for x in (math.inf, -math.inf, math.nan):
        assert np.isnan(sin_cos(x)).all()


def test_python_has_the_bits_of_c() -> None:
    interpreted = source_of(sin_cos)
    assert interpreted is not sin_cos
    for x in [*angles(), 3e8, -7e11]:
        assert interpreted(x) == sin_cos(x)
        assert sin(x) == sin_cos(x)[0]


def test_an_odd_and_an_even_function() -> None:
    for x in angles()[:200]:
        sine, cosine = sin_cos(x)
        assert sin_cos(-x) == (-sine, cosine)


@pytest.mark.parametrize("far", [1.1e6, -1e300])
def test_joint_positions_beyond_it_are_refused(far: float) -> None:
    robot = iiwa_dnn.load_robot("iiwa7")
    q = np.array(robot.start_posture())
    start = iiwa_dnn.Configuration(robot, q)
    target = iiwa_dnn.Target(start.position, start.rotation)
    controller = iiwa_dnn.Controller(robot, iiwa_dnn.DoubleIndicator(), dt=1e-3)
    controller.step(q, 0.0, target)
    shield = iiwa_dnn.Shield(robot)
    q[3] = far
    steps = [
        lambda: controller.step(q, 0.0, target),
        lambda: controller.step(q.tolist(), 0.0, target),
        lambda: shield.step(q, np.zeros(7)),
        lambda: iiwa_dnn.Configuration(robot, q),
    ]
    for step in steps:
        with pytest.raises(iiwa_dnn.InvalidInputError, match="q: must be within ±1048576 rad"):
            step()

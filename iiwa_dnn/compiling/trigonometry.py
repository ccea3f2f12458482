"""Compute sine and cosine by sums and products alone, with the same bits on every processor.

C libraries differ in the last digit. Here a multiple of pi/2, in four parts, is subtracted from the
angle (Cody and Waite, 1980); polynomials of degree five in the square of the rest, of least largest
error (Remez), give both values. Below `LARGEST` the error is less than 0.8 units in the last place.
"""

from .library import compiled

LARGEST = 2.0**20
"""Angle [rad] beyond which the reduction is coarser, and joint positions are refused."""

FARTHEST = 2.0**50
"""Angle [rad] above which rounding exceeds a turn: it counts as 0."""

QUARTERS = 2.0 / 3.141592653589793
TURN = 2.0 * 3.141592653589793

SHIFT = 1.5 * 2.0**52
"""Number that rounds others to integers where it is added and taken away."""

HALF_PI = (
    float.fromhex("0x1.921fb544p+0"),
    float.fromhex("0x1.0b4611a6p-34"),
    float.fromhex("0x1.3198a2ep-69"),
    float.fromhex("0x1.b839a252049c1p-104"),
)
"""Parts of pi/2; the first three have 33 bits, so that products with 20 more are exact."""

SINE = (
    float.fromhex("-0x1.5555555555549p-3"),
    float.fromhex("0x1.111111110f88ep-7"),
    float.fromhex("-0x1.a01a019c1398ap-13"),
    float.fromhex("0x1.71de3579306a5p-19"),
    float.fromhex("-0x1.ae5e673e34a66p-26"),
    float.fromhex("0x1.5d93446e5f63cp-33"),
)
"""Polynomial in z = r^2 for (sin r - r) / r^3, |r| <= pi/4."""

COSINE = (
    float.fromhex("0x1.555555555554cp-5"),
    float.fromhex("-0x1.6c16c16c15205p-10"),
    float.fromhex("0x1.a01a019cbd3abp-16"),
    float.fromhex("-0x1.27e4f8115237bp-22"),
    float.fromhex("0x1.1ee9f073bf9abp-29"),
    float.fromhex("-0x1.8fb0c48c9a27dp-37"),
)
"""Polynomial in z = r^2 for (cos r - 1 + z/2) / z^2."""


@compiled
def sin_cos(angle: float) -> tuple[float, float]:
    """Compute sine and cosine of an angle [rad].

    From `LARGEST` on, whole turns are subtracted as one product: the error is at most that of an
    angle which is off by one unit in its last place. From `FARTHEST` on, the angle counts as 0.
    Infinity and NaN give NaN.
    """
    x = angle
    if not abs(x) < LARGEST:
        x = x - TURN * (x / TURN + SHIFT - SHIFT) if abs(x) < FARTHEST else x - x
    k = x * QUARTERS + SHIFT - SHIFT
    first = x - k * HALF_PI[0]
    w = k * HALF_PI[1]
    near = first - w
    v = near - first
    rest = (first - (near - v)) - (w + v)  # near + rest = first - w, exactly
    tail = (rest - k * HALF_PI[2]) - k * HALF_PI[3]
    r = near + tail
    low = (near - r) + tail
    z = r * r
    p = SINE[3] + z * (SINE[4] + z * SINE[5])
    p = SINE[0] + z * (SINE[1] + z * (SINE[2] + z * p))
    sine = r + (r * (z * p) + low * (1.0 - 0.5 * z))
    p = COSINE[3] + z * (COSINE[4] + z * COSINE[5])
    p = COSINE[0] + z * (COSINE[1] + z * (COSINE[2] + z * p))
    one = 1.0 - 0.5 * z
    cosine = one + (((1.0 - one) - 0.5 * z) + (z * (z * p) - r * low))
    quadrant = int(k) % 4
    if quadrant == 1:
        return cosine, -sine
    if quadrant == 2:
        return -sine, -cosine
    if quadrant == 3:
        return -cosine, sine
    return sine, cosine


@compiled
def sin(angle: float) -> float:
    """Compute the sine of an angle [rad] with the bits of `sin_cos`."""
    return sin_cos(angle)[0]

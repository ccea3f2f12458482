"""Curves on the page, on logarithmic axes with powers of ten, and a line at the present time."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.results.record import FloatArray

LEAST = 1e-15
"""Smaller values are rounding errors, and drawn as this one."""

COLORS = ("#d6001c", "#1c7ed6", "#2b8a3e", "#e8590c", "#862e9c", "#0b7285", "#5c3d2e")
_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


class Curves:
    """One or more positive curves over time in a diagram of their own.

    Attributes:
        handle: The diagram on the page.
        now: Time of the vertical line; None: there is none.
        low: Lower end of the axis, a power of ten.
        high: Upper end of the axis, a power of ten.
    """

    now: float | None = None

    def __init__(
        self,
        gui: Any,
        title: str,
        colors: tuple[str, ...],
        ends: tuple[float, float],
        powers: bool = False,
    ) -> None:
        """Put an empty diagram on a page or in a browser, a color for each curve.

        With `powers` its ends, and the times of `show`, are decimal logarithms.
        """
        from viser import uplot  # of an extra

        self._uplot = uplot
        self._ends = ends
        self._powers = powers
        self.low = 0.0
        self.high = 0.0
        # An empty diagram would get no horizontal axis later.
        self._times: FloatArray = np.array(ends)
        self._values: FloatArray = np.ones((2, len(colors)))
        self.handle = gui.add_uplot(
            (self._times, *self._values.T, self._times),
            (
                uplot.Series(),
                *(uplot.Series(stroke=color, width=1) for color in colors),
                uplot.Series(stroke="#444", width=1, points={"show": False}),
            ),
            title=title,
            legend=uplot.Legend(show=False),
            height=170,
            padding=(12, 8, 0, 0),  # room for half a number above the axis
        )

    def show(self, times: FloatArray, values: FloatArray, now: float | None = None) -> None:
        """Draw curves; values that are not finite are left out.

        Args:
            times: Times [s], or their logarithms, (M,).
            values: Values in the unit of the title, not negative, (M,) or (M, k).
            now: Time of the vertical line; None: there is none.
        """
        values = values.reshape(len(times), -1)
        good = np.isfinite(values)
        some = good.any(axis=1)
        self._times = times[some]
        self._values = np.where(good, np.maximum(values, LEAST), np.nan)[some]
        if some.any():
            powers = np.log10(self._values)
            # Half a decade beyond the curves at least, also where they are constant.
            low = np.floor(np.nanmin(powers) - 0.5)
            self._scale(float(low), float(np.ceil(np.nanmax(powers) + 0.5)))
            self.mark(now)

    def mark(self, now: float | None) -> None:
        """Draw the curves with the line at the present time."""
        self.now = now
        times = self._times
        values = self._values
        line: FloatArray = np.full(len(times), self.low)
        if now is not None:
            k = int(np.searchsorted(times, now))
            times = np.insert(times, k, 3 * [np.clip(now, times[0], times[-1])])
            values = np.insert(values, k, 3 * [values[min(k, len(values) - 1)]], axis=0)
            line = np.insert(line, k, [self.low, self.high, self.low])
        self.handle.data = (times, *np.ascontiguousarray(values.T), line)

    def _scale(self, low: float, high: float) -> None:
        """Let the axis span from one power of ten to another."""
        if (10.0**low, 10.0**high) == (self.low, self.high):
            return
        uplot = self._uplot
        self.low = 10.0**low
        self.high = 10.0**high
        self.handle.scales = {
            "x": uplot.Scale(time=False, range=self._ends),
            "y": uplot.Scale(distr=3, log=10, range=(self.low, self.high)),
        }
        across = np.arange(*self._ends, 2.0)
        marks = {"splits": tuple(across.tolist()), "values": _named(across)} if self._powers else {}
        up = np.arange(low, high + 1.0, max(1.0, (high - low) // 4))
        labels = {"splits": tuple((10.0**up).tolist()), "values": _named(up)}
        self.handle.axes = uplot.Axis(**marks), uplot.Axis(**labels)


def _named(powers: NDArray[Any]) -> tuple[str, ...]:
    return tuple("10" + f"{power:.0f}".translate(_RAISED) for power in powers)

"""Words and bars on the page, as HTML."""

import html
import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from iiwa_dnn.results.record import FloatArray
from iiwa_dnn.robot.robot import Robot

PERIOD = 0.1
"""Time between two updates of words and bars [s]; the robot moves at every tick."""

_NEAR = 0.9  # distance from the middle, relative to that of a limit, from which a bar is red
_ROW = "display:flex;align-items:center;gap:6px;margin:3px 0;font-size:12px"


class Readout:
    """Words and joint bars on a page, renewed once in a `PERIOD`."""

    def __init__(self, gui: Any) -> None:
        """Put empty words and bars on a page."""
        self._facts = gui.add_html("")
        self._bars = gui.add_html("")
        self._age = np.inf

    def is_due(self, elapsed: float) -> bool:
        """Let `elapsed` seconds pass; return whether the last `show` is a period ago."""
        self._age += elapsed
        return self._age >= PERIOD

    def show(self, values: Mapping[str, str], robot: Robot, q: FloatArray) -> None:
        """Show named values, and the joint positions q (n,) [rad] of a robot."""
        self._age = 0.0
        self._facts.content = facts(values)
        self._bars.content = joint_bars(q, robot.q_lower, robot.q_upper, robot.joint_names)


def joint_bars(q: FloatArray, lower: FloatArray, upper: FloatArray, names: Sequence[str]) -> str:
    """Draw joint positions q (n,) [rad] as marks on bars from limit to limit, infinite for none.

    A mark near a limit, or beyond it, is red; returns HTML, one row a joint. Its label is q and its
    number, and its name too, unless all names (n,) end in the numbers.
    """
    rows = []
    numbered = all(re.search(rf"\D{i}$", name) for i, name in enumerate(names, 1))
    width = 18 if numbered else 90
    bars = zip(names, q, lower, upper, strict=True)
    for i, (name, angle, low, high) in enumerate(bars, 1):
        label = f"q{i}" if numbered else f"q{i} {html.escape(name)}"
        fraction = 0.5
        ends = ("-", "-")
        if np.isfinite(low) and np.isfinite(high):
            fraction = (angle - low) / (high - low)
            ends = (f"{low:.2f}", f"{high:.2f}")
        left = 100.0 * float(np.clip(fraction, 0.0, 1.0))
        color = "#d6001c" if abs(2.0 * fraction - 1.0) > _NEAR else "#1c7ed6"
        rows.append(
            f'<div style="{_ROW}"><span style="width:{width}px;'
            f'overflow-wrap:anywhere">{label}</span>'
            f'<span style="width:40px;text-align:right;color:#888">{ends[0]}</span>'
            '<span style="position:relative;flex:1;height:8px;background:#e5e7ec;'
            'border-radius:4px">'
            f'<span style="position:absolute;left:calc({left:.1f}% - 4px);top:-2px;width:8px;'
            f'height:12px;border-radius:3px;background:{color}"></span></span>'
            f'<span style="width:34px;color:#888">{ends[1]}</span>'
            f'<b style="width:52px;text-align:right">{angle:+.3f}</b></div>'
        )
    return '<div style="padding:2px 10px">' + "".join(rows) + "</div>"


def facts(values: Mapping[str, str]) -> str:
    """Return named values, one a row, as HTML; the text may hold anything."""
    rows = "".join(
        f'<div style="{_ROW}"><span style="flex:1;color:#666">{html.escape(name)}</span>'
        f'<b style="font-variant-numeric:tabular-nums">{html.escape(value)}</b></div>'
        for name, value in values.items()
    )
    return f'<div style="padding:2px 10px">{rows}</div>'


def verdict(reasons: Sequence[str]) -> str:
    """Return the reasons why a run is no success, or that it is one, as HTML."""
    color, lines = ("#d6001c", reasons) if reasons else ("#2b8a3e", ["completed within all limits"])
    rows = "".join(f"<div>{html.escape(line)}</div>" for line in lines)
    return f'<div style="padding:2px 10px;font-size:12px;color:{color}">{rows}</div>'


def marks(stretches: Sequence[tuple[float, float]]) -> str:
    """Mark stretches of a time bar, each from a fraction of it to another one, as HTML."""
    spans = "".join(
        f'<span style="position:absolute;left:{100.0 * start:.2f}%;top:0;height:6px;'
        f'min-width:2px;width:{100.0 * (end - start):.2f}%;background:#d6001c"></span>'
        for start, end in stretches
    )
    bar = "position:relative;height:6px;background:#e5e7ec;border-radius:3px"
    return f'<div style="padding:2px 10px"><div style="{bar}">{spans}</div></div>'


def length(metres: float) -> str:
    """Return a length in the unit that suits its size."""
    for unit, size in (("m", 1.0), ("mm", 1e-3), ("µm", 1e-6), ("nm", 1e-9)):
        if abs(metres) >= size:
            return f"{metres / size:.3g} {unit}"
    return f"{metres:.2g} m"

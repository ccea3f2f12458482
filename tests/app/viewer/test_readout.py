"""Words and bars on the page."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from iiwa_dnn.app.viewer import readout


def test_bars_stand_where_the_angles_are():
    lower = np.full(3, -2.0)
    upper = np.full(3, 2.0)
    page = readout.joint_bars(np.array([-2.0, 0.0, 1.0]), lower, upper, ["j1", "j2", "j3"])
    ET.fromstring(page)  # well-formed
    assert re.findall(r"left:calc\(([\d.]+)%", page) == ["0.0", "50.0", "75.0"]
    assert re.findall(r">([+-]\d\.\d{3})<", page) == ["-2.000", "+0.000", "+1.000"]


@pytest.mark.parametrize(
    ("angle", "near"), [(0.0, False), (1.7, False), (1.9, True), (-1.9, True), (2.5, True)]
)
def test_a_mark_near_a_limit_is_red(angle, near):
    page = readout.joint_bars(np.array([angle]), np.array([-2.0]), np.array([2.0]), ["j1"])
    assert ("#d6001c" in page) == near


def test_a_joint_without_limits():
    page = readout.joint_bars(np.array([9.0]), np.array([-np.inf]), np.array([np.inf]), ["j1"])
    assert "left:calc(50.0%" in page
    assert "#d6001c" not in page


def test_names_are_shown_where_they_do_not_end_in_the_joints_numbers():
    three = np.zeros(3)
    plain = readout.joint_bars(three, three - 1, three + 1, ["arm2_1", "arm2_2", "arm2_3"])
    assert re.findall(r">(q[^<]*)<", plain) == ["q1", "q2", "q3"]
    locked = readout.joint_bars(three, three - 1, three + 1, ["arm_1", "arm_3", "<b>"])
    assert re.findall(r">(q[^<]*)<", locked) == ["q1 arm_1", "q2 arm_3", "q3 &lt;b&gt;"]


def test_facts_cannot_break_the_page():
    page = readout.facts({"<b>name</b>": "a & b"})
    assert "&lt;b&gt;name&lt;/b&gt;" in page
    assert "a &amp; b" in page
    ET.fromstring(page)


@pytest.mark.parametrize(
    ("metres", "text"),
    [(1.5, "1.5 m"), (2e-3, "2 mm"), (3.04e-5, "30.4 µm"), (5e-9, "5 nm"), (1e-12, "1e-12 m")],
)
def test_lengths(metres, text):
    assert readout.length(metres) == text

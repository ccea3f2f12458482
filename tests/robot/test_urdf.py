"""Files that Pinocchio reads are read, others are refused in one line that names the place."""

import os
import re
import warnings

import numpy as np
import pinocchio as pin
import pytest

import iiwa_dnn as d
from helpers_physics import run_python
from iiwa_dnn.errors import IiwaDnnError, InvalidInputError
from iiwa_dnn.robot.mujoco_model import JointDynamics, compile_model
from iiwa_dnn.robot.shapes import visual_meshes, visual_shapes
from iiwa_dnn.robot.urdf import parser_messages

LIMIT = '<limit lower="-2" upper="2" effort="10" velocity="1"/>'
INERTIA = '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
BODY = f'<inertial><mass value="1"/>{INERTIA}</inertial>'
BALL = '<visual><geometry><sphere radius="0.1"/></geometry></visual>'


def joint(name: str, parent: str, child: str, kind: str = "revolute", axis: str = "0 1 0") -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="0.1 0 0.3" rpy="0 0.2 0"/><axis xyz="{axis}"/>{LIMIT}</joint>\n'
    )


ARM = (
    '<?xml version="1.0"?>\n<robot name="arm">\n'
    + "".join(f'<link name="{link}">{BODY}</link>\n' for link in ("base", "upper", "lower", "hand"))
    + joint("shoulder", "base", "upper", axis="0 0 1")
    + joint("elbow", "upper", "lower")
    + joint("wrist", "lower", "hand", "prismatic")
    + "</robot>\n"
)


def elbow(old: str, new: str) -> str:
    """Replace a text in the arm's second joint."""
    before, start, after = ARM.partition('<joint name="elbow"')
    assert old in start + after
    return before + (start + after).replace(old, new, 1)


def plus(content: str) -> str:
    return ARM.replace("</robot>", f"{content}</robot>")


READ = {
    "as it is": ARM,
    "lines before the declaration": "\n\n  " + ARM,
    "byte order mark": "\ufeff" + ARM,
    "default namespace": ARM.replace("<robot", '<robot xmlns="http://example.org/urdf"'),
    "unbound prefix": plus('<gazebo><p:a b:c="1">x</p:a></gazebo>'),
    "dashes in a comment": ARM.replace("<link", "<!------ links\n -- ---><link", 1),
    "ampersands": plus('<gazebo a="&amp;">a & b &lt; &#65;</gazebo>'),
    "another encoding declared": ARM.replace('"1.0"', '"1.0" encoding="utf-16"'),
    "not UTF-8": ARM.replace("<link", "<!-- Ger\xe4t --><link", 1).encode("latin-1"),
    "two declarations": '<?xml version="1.0"?>' + ARM,
    "end of a string in C": ARM + "\0\0",
    "version 1.2": ARM.replace('name="arm"', 'name="arm" version="1.2"'),
}


@pytest.mark.parametrize("content", READ.values(), ids=READ.keys())
def test_what_pinocchio_reads_is_read(written, content: str | bytes) -> None:
    path = written(content)
    theirs = pin.buildModelFromUrdf(str(path))
    robot = d.load_robot(path)
    assert robot.joint_names == tuple(theirs.names)[1:] == ("shoulder", "elbow", "wrist")
    q = np.array([0.3, -0.4, 0.5])
    data = theirs.createData()
    pin.framesForwardKinematics(theirs, data, q)
    tip = data.oMf[theirs.getFrameId("hand", pin.FrameType.BODY)]
    np.testing.assert_allclose(d.Configuration(robot, q).pose, tip.homogeneous, atol=1e-15)
    # Readers that know namespaces read the text that is kept.
    assert compile_model(robot, 1e-3, JointDynamics()).nq == 3


@pytest.mark.parametrize("limit", ['effort="-1" ', 'effort="0" ', ""])
def test_an_effort_is_not_needed(written, limit: str) -> None:
    robot = d.load_robot(written(elbow('effort="10" ', limit)))
    np.testing.assert_array_equal(robot.model.effortLimit, [10, 0, 10])


@pytest.mark.parametrize(
    ("attributes", "expected"),
    [
        ('acceleration="3" jerk="9"', [3.0, 9.0]),
        ('drake:acceleration="4" jerk="0"', [4.0, np.inf]),
    ],
)
def test_acceleration_and_jerk_limits_of_the_file(
    written, attributes: str, expected: list[float]
) -> None:
    robot = d.load_robot(written(elbow('velocity="1"', f'velocity="1" {attributes}')))
    np.testing.assert_array_equal(robot.limits[3:, 1], expected)
    assert np.isinf(robot.limits[3:, [0, 2]]).all()


FAULTS = {
    "no type": (elbow(' type="revolute"', ""), "joint [elbow] has no type"),
    "a type behind shapes that are left out": (
        elbow("revolute", "ball").replace(BODY, BODY + BALL.replace("sphere", "torus")),
        "Joint [elbow] has no known type [ball]",
    ),
    "no joint name": (elbow(' name="elbow"', ""), "unnamed joint"),
    "no parent": (elbow('<parent link="upper"/>', ""), "Joint [elbow] is missing a parent"),
    "parent misspelt": (
        elbow('"upper"', '"uper"'),
        "parent link [uper] of joint [elbow] not found$",
    ),
    "two parents": (plus(joint("twin", "base", "hand")), "joint 'twin' is in a loop, or its child"),
    "a loop aside": (
        plus('<link name="p"/><link name="q"/>' + joint("pq", "p", "q") + joint("qp", "q", "p")),
        "joint 'pq' is in a loop",
    ),
    "onto itself": (elbow('link="upper"', 'link="lower"'), "joint 'elbow' is in a loop"),
    "a loop of all": (plus(joint("back", "hand", "base")), "No root link found"),
    "no limit": (elbow(LIMIT, ""), "Joint [elbow] is of type REVOLUTE but it does not"),
    "velocity in words": (
        elbow('velocity="1"', 'velocity="fast"'),
        "joint 'elbow': velocity must be",
    ),
    "velocity nan": (elbow('velocity="1"', 'velocity="nan"'), "joint 'elbow': velocity must be"),
    "velocity below 0": (
        elbow('velocity="1"', 'velocity="-2.5"'),
        "joint 'elbow': velocity .*not '-2.5'",
    ),
    "limits equal": (
        elbow('lower="-2"', 'lower="2"'),
        "joint 'elbow': lower limit 2 is not below 2",
    ),
    "no range": (elbow('lower="-2" upper="2"', ""), "no range for joint 'elbow'"),
    "upper with its unit": (
        elbow('upper="2"', 'upper="2rad"'),
        "joint [elbow]: upper value (2rad)",
    ),
    "acceleration in words": (
        elbow("<limit", '<limit acceleration="x"'),
        "'elbow': acceleration must",
    ),
    "jerk nan": (elbow("<limit", '<limit jerk="nan"'), "joint 'elbow': jerk must be"),
    "ramp in words": (
        elbow("<limit", '<position_based_velocity_limits deceleration_limit="-6"/><limit'),
        "joint 'elbow': deceleration_limit must be",
    ),
    "axis with commas": (elbow('"0 1 0"', '"0,1,0"'), "axis element for joint [elbow]"),
    "axis zero": (elbow('"0 1 0"', '"0 0 0"'), "the axis of joint 'elbow' is zero"),
    "angles in degrees": (elbow('"0 0.2 0"', '"0 90\xb0 0"'), "origin element for joint [elbow]"),
    "mimic of nobody": (elbow(LIMIT, LIMIT + "<mimic/>"), "mimic element for joint  [elbow]"),
    "floating": (elbow("revolute", "floating"), "joint 'elbow' has 7 .*, not 1: lock it"),
    "tag left open": (elbow("</joint>", ""), "line 10"),
    "a key twice": (
        elbow('velocity="1"', 'velocity="1" velocity="2"'),
        "duplicate attribute: line 8",
    ),
    "empty": ("", "no element found: line 1"),
    "a program": (b"\x7fELF\x00\x01", "line 1"),
    "a web page": ("<!DOCTYPE html>\n<html><body>404</body></html>", "first element is <html>"),
    "no joint": ('<robot name="x"><link name="a"/></robot>', "^tip: no joint moves frame 'a'"),
    "lower nan": (elbow('"-2"', '"nan"'), "joint [elbow]: lower value (nan)"),
    "no links": ('<robot name="x"/>', "No link elements"),
    "material twice": (plus('<material name="m"><color rgba="1 0 0 1"/></material>' * 2), "'m'"),
}


@pytest.mark.parametrize(("content", "reason"), FAULTS.values(), ids=FAULTS.keys())
def test_a_fault_is_named_in_one_line(written, capfd, content: str | bytes, reason: str) -> None:
    path = written(content)
    with pytest.raises(IiwaDnnError) as caught:
        d.load_robot(path)
    message = str(caught.value)
    assert re.search(re.sub(r"[][()]", r"\\\g<0>", reason), message), message
    assert "\n" not in message
    assert getattr(caught.value, "path", str(path)) == str(path)
    assert capfd.readouterr().err == ""


LEFT_OUT = {
    "mass with its unit": (
        ARM.replace('value="1"', 'value="1kg"', 1),
        "mass [1kg] is not a float; ",
    ),
    "half an inertia": (ARM.replace(' ixy="0"', "", 1), "inertia element missing ixy attribute; "),
    "shape of no kind": (ARM.replace(BODY, BALL.replace("sphere", "torus"), 1), "'torus'; "),
}


@pytest.mark.parametrize(("content", "reason"), LEFT_OUT.values(), ids=LEFT_OUT.keys())
def test_what_is_left_out_is_said(written, capfd, content: str, reason: str) -> None:
    with pytest.warns(UserWarning, match=re.escape(reason) + r".*Link \[base\]$"):
        robot = d.load_robot(written(content))
    visual_meshes(robot)  # which reads the text again
    assert capfd.readouterr().err == ""


SOFT = {
    "inside": ('soft_lower_limit="-1.5" soft_upper_limit="1.2"', (-1.5, 1.2)),
    "one side inside": ('soft_lower_limit="-3" soft_upper_limit="1.2"', (-2.0, 1.2)),
    "outside": ('soft_lower_limit="-3" soft_upper_limit="3"', (-2.0, 2.0)),
    "none": ("", (-2.0, 2.0)),
    "equal": ('soft_lower_limit="1" soft_upper_limit="1"', (-2.0, 2.0)),
}


@pytest.mark.parametrize(("given", "held"), SOFT.values(), ids=SOFT.keys())
def test_soft_limits_are_position_limits_where_they_are_inside(written, given, held) -> None:
    soft = f'{LIMIT}<safety_controller k_velocity="10" {given}/>'
    robot = d.load_robot(written(elbow(LIMIT, soft)))
    assert (robot.q_lower[1], robot.q_upper[1]) == held
    assert (robot.q_lower[0], robot.q_upper[0]) == (-2.0, 2.0)


@pytest.mark.parametrize(("lower", "upper"), [(3, 4), (1, -1)])
def test_soft_limits_that_leave_nothing_of_the_range_are_said(written, lower, upper) -> None:
    given = f'soft_lower_limit="{lower}" soft_upper_limit="{upper}"'
    soft = f'{LIMIT}<safety_controller k_velocity="1" {given}/>'
    said = f"joint 'elbow', {lower} to {upper}, leave nothing of -2 to 2, which"
    with pytest.warns(UserWarning, match=said):
        robot = d.load_robot(written(elbow(LIMIT, soft)))
    assert (robot.q_lower[1], robot.q_upper[1]) == (-2.0, 2.0)


@pytest.mark.parametrize(
    ("name", "upper", "unit"), [("elbow", "120", "degrees"), ("wrist", "800", "mm")]
)
def test_a_limit_in_another_unit_is_asked_about(written, name: str, upper: str, unit: str) -> None:
    before, start, after = ARM.partition(f'<joint name="{name}"')
    text = before + start + after.replace('upper="2"', f'upper="{upper}"', 1)
    with pytest.warns(UserWarning, match=f"joint '{name}' has a limit of {upper}: is it in {unit}"):
        d.load_robot(written(text))


def test_other_output_still_goes_to_the_standard_error(capfd) -> None:
    with parser_messages() as messages:
        os.write(2, b"mine\nError:   theirs\n         at line 3 in a.cpp\n")
        os.write(2, b"Error:   mine too\n")
    assert messages == ["theirs"]
    assert capfd.readouterr().err == "mine\nError:   mine too\n"


def test_a_program_without_a_standard_error_gets_the_reason(written) -> None:
    path = written(elbow("revolute", "Revolute"))
    code = (
        f"import os; os.close(2); import iiwa_dnn\n"
        f"try: iiwa_dnn.load_robot({str(path)!r})\nexcept Exception as error: print(error)"
    )
    assert "known type [Revolute]" in run_python(code).stdout


TWINS = (
    '<robot name="twins">'
    + "".join(f'<link name="{link}"/>' for link in ("base", "a", "b", "hand", "tool", "finger"))
    + joint("a", "base", "a")
    + joint("b", "a", "b")
    + '<joint name="hand" type="fixed"><parent link="b"/><child link="hand"/></joint>'
    + joint("mount", "hand", "tool", "fixed").replace(LIMIT, "")
    + joint("finger", "tool", "finger")
    + "</robot>"
)


@pytest.mark.parametrize("locked", ["a", "b", "finger"])
def test_a_joint_with_the_name_of_its_link_is_locked(written, locked: str) -> None:
    whole = d.load_robot(written(TWINS))
    robot = d.load_robot(written(TWINS), locked=locked)
    assert robot.joint_names == tuple(name for name in ("a", "b", "finger") if name != locked)
    assert robot.frame_names == whole.frame_names
    q = np.array([0.3, -0.4])
    full = np.insert(q, whole.joint_names.index(locked), 0.0)
    for name in whole.frame_names:
        pose = d.Configuration(whole, full).frame(name).pose
        np.testing.assert_allclose(d.Configuration(robot, q).frame(name).pose, pose, atol=1e-15)


def test_a_missing_mesh_is_said_where_the_robot_is_drawn(written) -> None:
    mesh = '<visual><geometry><mesh filename="package://gone/arm.stl"/></geometry></visual>'
    robot = d.load_robot(written(ARM.replace(BODY, mesh, 1)))
    with pytest.warns(UserWarning, match="^arm is drawn without its shapes: .*gone/arm.stl"):
        assert visual_shapes(robot).ngeoms == 0
    model = d.load_robot(robot.model)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert visual_shapes(model).ngeoms == 0


def test_kinetic_energy_of_a_negative_mass_is_refused(written) -> None:
    text = ARM.replace(
        '"upper"><inertial><mass value="1"/>', '"upper"><inertial><mass value="-3"/>'
    )
    robot = d.load_robot(written(text))
    start = d.Configuration(robot, [0.3, -0.4, 0.5])
    scheme = d.Scheme(costs=[d.KineticEnergy(kinetic="inertia")], tasks=[d.PositionTask()])
    with pytest.raises(InvalidInputError, match=r"negative mass, on joint 'shoulder' \(-3 kg\)$"):
        scheme.build_qp(start, d.Target(start.position))
    unweighted = d.Scheme(costs=[d.KineticEnergy()], tasks=[d.PositionTask()])
    assert unweighted.build_qp(start, d.Target(start.position)).P.shape == (3, 3)


def test_soft_limits_of_a_continuous_joint_are_none(written) -> None:
    given = 'soft_lower_limit="-3.14" soft_upper_limit="3.14"'
    soft = f'{LIMIT}<safety_controller k_velocity="1" {given}/>'
    text = elbow(LIMIT, soft).replace('type="revolute"', 'type="continuous"')
    robot = d.load_robot(written(text))
    assert (robot.q_lower[1], robot.q_upper[1]) == (-np.inf, np.inf)

"""Runs that track several frames, each with its own reference."""

import numpy as np
import pinocchio as pin
import pytest

import iiwa_dnn as d
from helpers_simulation import paper_robot, paper_start

ELBOW = "iiwa7_link_4"


def poses(record: d.Record, frame: str) -> np.ndarray:
    # Pinocchio's own forward kinematics, not the views that the package reads.
    model = paper_robot().model
    data = model.createData()
    found = []
    for q in record.q:
        pin.framesForwardKinematics(model, data, q)
        found.append(data.oMf[model.getFrameId(frame, pin.FrameType.BODY)].copy())
    return np.array([pose.homogeneous for pose in found])


def test_every_tracked_frame_follows_its_reference_and_is_recorded() -> None:
    robot, start = paper_robot(), paper_start()
    # The elbow has three coordinates but two joints to move it sideways; the tip takes the rest.
    paths = {
        robot.tip: d.Circle(radius=0.02, period=1.0).anchored(start),
        ELBOW: d.Line((0.0, 0.01, 0.0), 1.0).anchored(start.frame(ELBOW)),
    }
    both = d.Scheme(
        [d.CyclicMotion()],
        [d.PositionTask(), d.PositionTask(frame=ELBOW, weight=0.5)],
        [d.JointLimits()],
    )
    record = d.simulate(robot, both, paths, start.q, dt=1e-3, duration=1.0)
    assert d.failures(record) == []
    assert record.settings["tip"] == robot.tip
    assert record.settings["frames"] == [ELBOW]
    recorded = poses(record, ELBOW)
    np.testing.assert_allclose(record.frame_position[:, 0], recorded[:, :3, 3], rtol=0, atol=1e-14)
    np.testing.assert_allclose(record.frame_rotation[:, 0], recorded[:, :3, :3], atol=1e-14)
    wanted = paths[ELBOW].sample(record.t)
    np.testing.assert_array_equal(record.frame_position_desired[:, 0], wanted.position)
    np.testing.assert_array_equal(record.frame_rotation_desired[:, 0], wanted.rotation)
    metrics = d.compute_metrics(record)
    distance = np.linalg.norm(recorded[:, :3, 3] - wanted.position, axis=1).max()
    assert metrics["frames"][ELBOW]["max_position_error_m"] == pytest.approx(distance)
    assert metrics["max_position_error_m"] < 1e-4


def test_a_run_without_a_task_of_the_tip_records_the_frame_that_it_tracks() -> None:
    robot, start = paper_robot(), paper_start()
    path = d.Circle(radius=0.01, period=0.5).anchored(start.frame(ELBOW))
    soft = d.Scheme([d.CyclicMotion(weight=1e-3)], [d.PositionTask(frame=ELBOW, weight=1.0)])
    record = d.simulate(robot, soft, {ELBOW: path}, start.q, dt=1e-3)
    assert record.settings["tip"] == ELBOW
    np.testing.assert_allclose(record.position, poses(record, ELBOW)[:, :3, 3], atol=1e-14)
    np.testing.assert_array_equal(record.position_desired, path.sample(record.t).position)
    assert not len(record.frame_position)

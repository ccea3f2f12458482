"""The shield of iiwa_dnn."""

import iiwa_dnn
from benchmarks.hostile.serve import serve


def make(setup):
    """Return the filter, with the package's own capsules of the arm."""
    lower, upper, velocity, acceleration, jerk = setup["limits"][:5]
    robot = iiwa_dnn.load_robot(setup["arm"]["name"])
    robot = robot.with_limits(lower, upper, velocity, acceleration, jerk)
    balls = zip(setup["spheres"], setup["radii"], strict=True)
    spheres = [iiwa_dnn.Sphere(center, radius) for center, radius in balls]
    avoidance = iiwa_dnn.CollisionAvoidance(spheres, False, distance=setup["distance"])
    longest = setup["dt"] * (1.0 + setup["jitter"])
    made = iiwa_dnn.Shield(
        robot,
        setup["dt"],
        avoidance if spheres else None,
        delay=setup["late"],
        longest_period=longest if setup["jitter"] else None,
    )

    def act(state, request, dt):
        wanted = request or {}
        period = {"dt": dt} if setup["jitter"] else {}
        if "position" in wanted:
            return made.step(state["q"], position=wanted["position"], **period).dq
        return made.step(state["q"], wanted.get("velocity"), **period).dq

    return act


serve(make)

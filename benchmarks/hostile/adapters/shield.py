"""The shield of iiwa_dnn."""

import iiwa_dnn
from benchmarks.hostile.contenders import FRAME, PERSON
from benchmarks.hostile.families import WALK
from benchmarks.hostile.serve import serve

FIELD = 2.5
"""Radius of the ball in which a person is seen [m]."""


def make(setup):
    """Return the filter, with the package's own capsules of the arm."""
    robot = iiwa_dnn.load_robot(setup["arm"]["name"])
    robot = robot.with_limits(*setup["limits"][:5])
    if setup["payload"]:
        robot = robot.with_payload((0.0, setup["payload"]), center=[0.0, 0.0, 0.0])
    balls = zip(setup["spheres"], setup["radii"], strict=True)
    still = [] if setup["person"] else [iiwa_dnn.Sphere(*ball) for ball in balls]
    avoidance = iiwa_dnn.CollisionAvoidance(still, False, distance=setup["distance"])
    longest = setup["dt"] * (1.0 + setup["jitter"])
    has_people = {"people": 1, "field": FIELD, "people_speed": WALK, "latency": FRAME}
    made = iiwa_dnn.Shield(
        robot,
        setup["dt"],
        [] if setup["person"] else avoidance if still else None,
        delay=setup["late"],
        longest_period=longest if setup["jitter"] else None,
        **has_people if setup["person"] else {},
    )
    if setup["payload"]:
        others = [limit for limit in made.limits if not isinstance(limit, iiwa_dnn.TorqueLimits)]
        made.limits = (*others, iiwa_dnn.TorqueLimits(1.0, friction=0.0))

    followed = [-1.0]  # first time of the last chunk [s]

    def act(state, request, dt):
        wanted = request or {}
        given = {"dt": dt} if setup["jitter"] else {}
        if setup["person"]:
            seen = state["spheres"][0]
            given |= {"people": [(seen, seen, PERSON)], "age": float(state["age"])}
        if "chunk" in wanted:
            times, positions = wanted["chunk"]
            if times[0] > followed[-1]:
                followed.append(float(times[0]))
                made.follow(times, positions, now=float(state["t"]))
            return made.step(state["q"], **given).dq
        if "position" in wanted:
            return made.step(state["q"], position=wanted["position"], **given).dq
        return made.step(state["q"], wanted.get("velocity"), **given).dq

    return act


serve(make)

"""``fri-robot``: a robot for programs that speak KUKA's FRI."""

import sys
from importlib.util import find_spec

from iiwa_dnn.app.options import FriRobotOptions
from iiwa_dnn.robot import load_robot
from iiwa_dnn.simulation import IdealPlant, MujocoPlant
from iiwa_dnn.simulation.fri_robot import FriController, serve


def run(options: FriRobotOptions) -> int:
    """Serve one session; print its states, and at the end its packets; return the exit code."""
    robot = load_robot(options.robot)
    q0 = options.q0 or robot.start_posture()
    ideal = options.ideal or find_spec("mujoco") is None
    plant = IdealPlant() if ideal else MujocoPlant()
    controller = FriController(robot, plant, q0, options.period)
    shown = ""

    def say(line: str) -> None:
        if not options.quiet:
            print(line, flush=True)

    def show(controller: FriController) -> None:
        nonlocal shown
        line = controller.state.name
        if options.verbose:
            line += f", connection {controller.connection.quality.name}"
        if line != shown:
            say(line)
        shown = line

    arm = "ideal arm" if ideal else "arm in MuJoCo"
    to = f"{options.host}:{options.port} every {1e3 * controller.period:g} ms"
    say(f"{robot.name}, {arm}: messages to {to}")
    show(controller)
    serve(controller, options.host, options.port, options.own_port, options.realtime, show)
    packets = sorted(controller.connection.packets.items())
    say("commands: " + ", ".join(f"{count:,} {kind}" for kind, count in packets))
    if controller.fault is None:
        return 0
    print(f"the session ended: {controller.fault}", file=sys.stderr)
    return 1

"""franka-sim by a clock that waits: a cycle lasts until the client's command has been applied.

The server's own Python runs this file. By the wall clock a machine that stalls loses commands, and
nothing shows whether the client's motion was good. Here commands are lost at random, and as
libfranka documents it: a late packet is dropped, and the robot goes on without it.
"""

import random
import time

import franka_sim
from franka_sim import run_server
from franka_sim.comm_constraints import CommConstraintTracker
from franka_sim.mujoco_franka_sim import MujocoFrankaSim
from franka_sim.server import lifecycle

PATIENCE = 1.0  # for a client that has answered before [s]
TURN = 2e-5  # between two looks for the answer [s]
LOSSES = 0.01  # ratio of the cycles in which a loss begins
LONGEST = 5  # cycles that are lost in a row


class LossyTracker(CommConstraintTracker):
    """Counts the cycles, and loses the commands of some."""

    random = random.Random(0)  # of all connections: each has other losses
    remaining = 0
    is_lost = False
    is_silent = False
    heard = False

    def command_received(self, command_message_id):
        if self.remaining == 0 and self.consecutive_lost == 0 and self.random.random() < LOSSES:
            self.remaining = self.random.randint(1, LONGEST)
        self.heard = True
        self.is_lost = self.remaining > 0
        self.remaining -= self.is_lost
        return super().command_received(0 if self.is_lost else command_message_id)  # no state's id

    @property
    def awaiting_answer(self):
        return super().awaiting_answer and not self.is_lost

    def tick(self, published_id):
        self.is_silent = not self.heard
        self.is_lost = False
        self.heard = False
        return super().tick(published_id)


class LockstepServer(franka_sim.FrankaSimServer):
    """A server whose cycle ends with the client's answer, and moves the arm once."""

    def _drain_gate(self, answer_deadline=0.0):
        if not self.comm.is_silent:
            answer_deadline = time.perf_counter() + PATIENCE
        while self.connection_running and time.perf_counter() < answer_deadline:
            if not self.comm.awaiting_answer:
                break
            time.sleep(TURN)
        super()._drain_gate()
        self.physics_sim.step()
        return 0.0

    def _absorb_within_motion_limits(self, command, *, fresh):
        return fresh and super()._absorb_within_motion_limits(command, fresh=fresh)


def idle(simulation):
    """Take the place of the physics' own loop."""
    simulation._read_and_publish_state()
    while simulation.running:
        time.sleep(0.05)


if __name__ == "__main__":
    lifecycle.CommConstraintTracker = LossyTracker
    franka_sim.FrankaSimServer = LockstepServer
    MujocoFrankaSim.run_simulation = idle
    run_server.main()

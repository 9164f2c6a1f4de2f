"""Turtles that nobody looks at: no updates while they stand still, and the same motion as under observation."""

import json
import os
import sys
from pathlib import Path

import pytest

from lockstep.test_runs import run, script

pytestmark = pytest.mark.skipif(os.name == "nt", reason="the runs are interrupted by signals")

PROGRAM = """
import json

import rclpy
from geometry_msgs.msg import Twist, Vector3
from rclpy.duration import Duration
from rclpy.executors import SingleThreadedExecutor
from turtlesim.msg import Pose
from turtlesim.srv import TeleportAbsolute

from daidalos.nodes.turtlesim.turtlesim_node import TurtleSim

updates = {"watched": 0, "alone": 0}

class Counted(TurtleSim):
    def _update(self):
        updates[self.get_namespace()[1:]] += 1
        super()._update()

rclpy.init()
simulators = {name: Counted(namespace=name) for name in updates}
node = rclpy.create_node("driver")
executor = SingleThreadedExecutor()
for one in (*simulators.values(), node):
    executor.add_node(one)
poses = []
node.create_subscription(Pose, "/watched/turtle1/pose", lambda message: None, 10)
commands = [node.create_publisher(Twist, f"/{name}/turtle1/cmd_vel", 10) for name in simulators]
teleports = [node.create_client(TeleportAbsolute, f"/{name}/turtle1/teleport_absolute") for name in simulators]

def spin(seconds):
    future = executor.create_future()
    timer = node.create_timer(seconds, lambda: future.set_result(None))
    executor.spin_until_future_complete(future)
    node.destroy_timer(timer)

def states():
    turtles = [simulator._turtles["turtle1"].turtle for simulator in simulators.values()]
    return [(turtle.x, turtle.y, turtle.theta) for turtle in turtles]

log = []
for pause in (3.001, 0.3, 2.5057, 10.003):
    spin(pause)
    for publisher in commands:
        publisher.publish(Twist(linear=Vector3(x=1.0 + pause), angular=Vector3(z=1.0)))
    spin(1.5)
    log.append(states())
spin(5.0)
for client in teleports:
    client.call_async(TeleportAbsolute.Request(x=20.0, y=2.0, theta=0.0))
spin(1.0)
log.append(states())
before = dict(updates)
node.create_subscription(Pose, "/alone/turtle1/pose", poses.append, 10)
spin(1.0)
print(json.dumps({"log": log, "updates": before, "heard": len(poses)}))
"""


@pytest.mark.slow
def test_turtles_that_nobody_watches_move_alike_and_rest(tmp_path: Path) -> None:
    result = run(sys.executable, script(tmp_path, PROGRAM), folder=tmp_path)
    assert result.returncode == 0, result.stderr
    told = json.loads(result.stdout.splitlines()[-1])
    assert all(watched == alone for watched, alone in told["log"])
    assert len({tuple(watched) for watched, _ in told["log"]}) == 5
    assert told["log"][-1][0][0] < 12.0  # the step after the teleport took it back within the walls
    assert told["updates"]["watched"] > 1500
    assert told["updates"]["alone"] < 400
    assert 60 <= told["heard"] <= 63

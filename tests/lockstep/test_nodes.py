"""What nodes wait with, in lock-step: executors of every kind, rates, calls, lifecycle, transforms, message filters."""

import json
import os
import sys
from pathlib import Path

import pytest

from lockstep.test_runs import run, script

pytestmark = pytest.mark.skipif(os.name == "nt", reason="the runs are interrupted by signals")

NODES = """
import json, sys, threading, time

import message_filters
import rclpy
from builtin_interfaces.msg import Time as TimeMessage
from geometry_msgs.msg import PointStamped, TransformStamped
from lifecycle_msgs.srv import ChangeState
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.experimental.events_executor import EventsExecutor
from rclpy.node import Node
from rclpy.time import Time
from std_msgs.msg import Header
from std_srvs.srv import Trigger
from tf2_ros import Buffer, StaticTransformBroadcaster, TransformBroadcaster, TransformListener

rclpy.init()
begun = time.time()
log = {}

def now():
    return round(time.time() - begun, 6)

class Server(Node):
    def __init__(self):
        super().__init__("server")
        self.create_service(Trigger, "slow", self.answer, callback_group=ReentrantCallbackGroup())

    def answer(self, request, response):
        time.sleep(0.5)
        response.success = True
        return response

# Each kind of executor, and two calls that wait within callbacks of one node at the same time.
for kind in (SingleThreadedExecutor, lambda: MultiThreadedExecutor(4), EventsExecutor):
    start = time.time()
    executor, server, caller = kind(), Server(), rclpy.create_node("caller")
    seen = []
    other = SingleThreadedExecutor()
    other.add_node(server)
    spun = threading.Thread(target=other.spin, daemon=True)
    spun.start()
    group = ReentrantCallbackGroup()
    client = caller.create_client(Trigger, "slow", callback_group=group)
    timer = caller.create_timer(0.25, lambda: seen.append(round(time.time() - start, 6)), callback_group=group)
    executor.add_node(caller)
    assert client.wait_for_service(timeout_sec=5.0)
    future = client.call_async(Trigger.Request())
    executor.spin_until_future_complete(future)
    seen.append(("answer", future.result().success, round(time.time() - start, 6)))
    log.setdefault("executors", []).append(seen)
    other.shutdown()
    executor.shutdown()
    spun.join()
    server.destroy_node()
    caller.destroy_node()

# Two calls that block within callbacks of one node at the same time, and a rate, in a multi-threaded executor.
begun = time.time()
server, node = Server(), rclpy.create_node("node")
executor = MultiThreadedExecutor(6)
executor.add_node(server)
executor.add_node(node)
spinner = threading.Thread(target=executor.spin, daemon=True)
spinner.start()
client = node.create_client(Trigger, "slow", callback_group=ReentrantCallbackGroup())
calls, done = [], threading.Semaphore(0)

def call():
    timer.cancel()
    calls.append((client.call(Trigger.Request()).success, now()))
    done.release()

for _ in range(2):
    timer = node.create_timer(0.1, call, callback_group=MutuallyExclusiveCallbackGroup())
    done.acquire()
log["calls"] = calls
rate, begun = node.create_rate(10.0), time.time()
for _ in range(3):
    rate.sleep()
log["rate"] = now()
begun = time.time()
log["slept"] = node.get_clock().sleep_for(Duration(seconds=1.25)), now()

# Lifecycle.
class Managed(LifecycleNode):
    def on_configure(self, state):
        time.sleep(0.125)
        return TransitionCallbackReturn.SUCCESS

managed = Managed("managed")
executor.add_node(managed)
begun = time.time()
change = node.create_client(ChangeState, "managed/change_state")
change.wait_for_service()
request = ChangeState.Request()
request.transition.id = 1
log["lifecycle"] = change.call(request).success, managed._state_machine.current_state[1], now()

# A lookup that waits for a transform of the future, and one that waits in vain.
buffer = Buffer(node=node)
listener = TransformListener(buffer, node)
broadcaster = TransformBroadcaster(node)

def transform():
    message = TransformStamped()
    message.header.frame_id, message.child_frame_id = "map", "odom"
    message.header.stamp = node.get_clock().now().to_msg()
    message.transform.rotation.w = 1.0
    broadcaster.sendTransform(message)

sender = node.create_timer(0.2, transform)
begun = time.time()
wanted = node.get_clock().now() + Duration(seconds=1.0)
buffer.lookup_transform("map", "odom", wanted, timeout=Duration(seconds=3.0))
log["transform"] = now()
begun = time.time()
log["no transform"] = buffer.can_transform("map", "nowhere", Time(), timeout=Duration(seconds=0.7)), now()

# Message filters.
pairs, publishers = [], [node.create_publisher(PointStamped, name, 10) for name in ("left", "right")]
filters = [message_filters.Subscriber(node, PointStamped, name) for name in ("left", "right")]
both = message_filters.ApproximateTimeSynchronizer(filters, 10, 0.05)
both.registerCallback(lambda a, b: pairs.append((a.header.stamp.nanosec, b.header.stamp.nanosec)))
for k in range(3):
    for offset, publisher in zip((0, 20_000_000), publishers):
        publisher.publish(PointStamped(header=Header(stamp=TimeMessage(sec=1, nanosec=100_000_000 * k + offset))))
    time.sleep(0.1)
log["pairs"] = pairs
print(json.dumps(log))
"""


def test_nodes_wait_for_the_stepped_time_in_all_ways(tmp_path: Path) -> None:
    result = run(sys.executable, script(tmp_path, NODES), folder=tmp_path)
    assert result.returncode == 0, result.stderr
    log = json.loads(result.stdout)
    for seen in log["executors"]:
        assert seen == [0.25, ["answer", True, 0.5]] or seen == [0.25, 0.5, ["answer", True, 0.5]]
    assert log["calls"] == [[True, pytest.approx(0.6)], [True, pytest.approx(1.2)]]
    assert log["rate"] == pytest.approx(0.3, abs=1e-3)
    assert log["slept"] == [True, pytest.approx(1.25)]
    assert log["lifecycle"] == [True, "inactive", pytest.approx(0.125)]
    assert 1.0 <= log["transform"] <= 1.2 + 1e-6
    assert log["no transform"] == [False, pytest.approx(0.7, abs=0.05)]
    assert log["pairs"] == [[100_000_000 * k, 100_000_000 * k + 20_000_000] for k in range(3)]


EVENTS = """
import sys
from launch import LaunchDescription
from launch.actions import EmitEvent, ExecuteProcess, LogInfo, RegisterEventHandler, TimerAction
from launch.event_handlers import OnProcessExit, OnProcessStart, OnProcessIO
from launch.events import Shutdown


def generate_launch_description():
    first = ExecuteProcess(cmd=[sys.executable, "first.py"], output="screen", name="first")
    second = ExecuteProcess(cmd=[sys.executable, "second.py"], output="screen", name="second", respawn=True,
                            respawn_delay=0.5, respawn_max_retries=2)
    return LaunchDescription([
        first,
        RegisterEventHandler(OnProcessStart(target_action=first, on_start=[LogInfo(msg="it has started")])),
        RegisterEventHandler(OnProcessIO(target_action=first,
                             on_stdout=lambda event: LogInfo(msg="it said " + event.text.decode().strip()))),
        RegisterEventHandler(OnProcessExit(target_action=first, on_exit=[second])),
        TimerAction(period=10.0, actions=[EmitEvent(event=Shutdown(reason="enough"))]),
    ])
"""


def test_launch_events_come_at_their_times(tmp_path: Path) -> None:
    script(tmp_path, "import time; time.sleep(3); print('hello', time.time())", "first.py")
    script(tmp_path, "import time; print('at', time.time()); time.sleep(1); raise SystemExit(1)", "second.py")
    result = run("ros2", "launch", script(tmp_path, EVENTS, "events.launch.py"), folder=tmp_path)
    assert result.returncode == 0, result.stdout + result.stderr
    printed = result.stdout
    assert "it has started" in printed
    assert "it said hello 1577836803" in printed
    times = [float(line.rpartition(" ")[2]) - 1577836803.0 for line in printed.splitlines() if "] at " in line]
    assert times == [pytest.approx(0.0, abs=0.1), pytest.approx(1.5, abs=0.1), pytest.approx(3.0, abs=0.1)]

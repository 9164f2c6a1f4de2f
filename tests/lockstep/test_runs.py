"""Programs in lock-step, as users start them: each run is a process."""

import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from daidalos.lockstep.options import Options

pytestmark = pytest.mark.skipif(os.name == "nt", reason="the runs are interrupted by signals")


def run(
    *command: object, folder: Path, options: Options | None = None, hash_seed: int = 0
) -> subprocess.CompletedProcess[str]:
    words = (options or Options()).words()
    start = [sys.executable, "-m", "daidalos.lockstep.start", *words, "--", *map(str, command)]
    environment = os.environ | {
        "RMW_IMPLEMENTATION": "rmw_daidalos_inprocess",
        "PYTHONHASHSEED": str(hash_seed),
        "ROS_HOME": str(folder / "ros"),
    }
    return subprocess.run(start, cwd=folder, env=environment, capture_output=True, text=True, timeout=600, check=False)


def script(folder: Path, text: str, name: str = "program.py") -> Path:
    path = folder / name
    path.write_text(text)
    return path


EVERYTHING = """
import asyncio, datetime, json, os, queue, random, threading, time, uuid
from concurrent.futures import ThreadPoolExecutor

import numpy as np

start = time.time()
log = {"epoch": start}
event, ready = threading.Event(), threading.Condition()
box = queue.Queue()
local = threading.local()
local.name = "main"

def worker():
    local.name = "worker"
    time.sleep(1.5)
    box.put(("first", time.time() - start))
    event.set()
    with ready:
        ready.notify_all()

thread = threading.Thread(target=worker)
thread.start()
log["early"] = event.wait(0.5)
log["got"] = box.get()
thread.join()
log["alive"] = thread.is_alive()
log["local"] = local.name
try:
    box.get(timeout=2.0)
except queue.Empty:
    log["empty at"] = time.time() - start

with ThreadPoolExecutor(4) as pool:
    log["pool"] = list(pool.map(lambda k: (time.sleep(0.1 * (4 - k)), k)[1], range(4)))
log["after pool"] = round(time.time() - start, 9)

async def ticks():
    loop = asyncio.get_running_loop()
    done = loop.create_future()
    threading.Timer(0.25, lambda: loop.call_soon_threadsafe(done.set_result, time.time() - start)).start()
    await asyncio.sleep(0.1)
    return await asyncio.wait_for(done, 1.0)

log["asyncio"] = round(asyncio.run(ticks()), 9)
deadline = time.monotonic() + 0.2
while time.monotonic() < deadline:
    pass
log["busy"] = round(time.time() - start, 3)
log["now"] = datetime.datetime.now(datetime.timezone.utc).year
log["random"] = [random.random(), random.randint(0, 9), float(np.random.normal()), str(uuid.uuid4()),
                 float(np.random.default_rng().normal()), os.urandom(4).hex()]
print(json.dumps(log))
"""


@pytest.mark.slow
def test_threads_queues_pools_event_loops_and_clocks_follow_the_stepped_time(tmp_path: Path) -> None:
    path = script(tmp_path, EVERYTHING)
    first, second, other = (run(sys.executable, path, folder=tmp_path, options=Options(seed)) for seed in (1, 1, 2))
    assert first.returncode == 0, first.stderr
    assert first.stdout == second.stdout
    log, another = json.loads(first.stdout), json.loads(other.stdout)
    assert log["random"] != another["random"]
    assert log["epoch"] == 1577836800.0
    assert log["early"] is False
    assert log["got"] == ["first", 1.5]
    assert (log["alive"], log["local"]) == (False, "main")
    assert log["empty at"] == 3.5
    assert log["pool"] == [0, 1, 2, 3]
    assert log["after pool"] == pytest.approx(3.9, abs=1e-6)
    assert log["asyncio"] == pytest.approx(4.15, abs=1e-6)
    assert log["busy"] == pytest.approx(4.35, abs=2e-3)
    assert log["now"] == 2020


GRAPH = """
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package="turtlesim", executable="turtlesim_node"),
        Node(package="turtlesim", executable="draw_square"),
        Node(package="demo_nodes_py", executable="talker"),
        Node(package="demo_nodes_py", executable="listener", output="screen"),
        Node(package="examples_rclpy_minimal_action_server", executable="server"),
        Node(package="examples_rclpy_minimal_action_client", executable="client", output="screen"),
    ])
"""


@pytest.mark.slow
def test_a_launch_gives_the_same_bag_every_time(tmp_path: Path) -> None:
    digests = []
    for number in (1, 2):
        folder = tmp_path / str(number)
        folder.mkdir()
        launch = script(folder, GRAPH, "graph.launch.py")
        options = Options(until_s=12.0, bag="bag")
        result = run("ros2", "launch", launch, folder=folder, options=options)
        assert result.returncode == 0, result.stdout + result.stderr
        assert "I heard: [Hello World: 9]" in result.stderr + result.stdout
        assert "Goal succeeded" in result.stderr + result.stdout
        digests.append(
            {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in (folder / "bag").iterdir()}
        )
    assert set(digests[0]) == {"bag_0.mcap", "metadata.yaml"}
    assert digests[0] == digests[1]


def test_programs_that_cannot_be_started_are_named_and_the_others_run(tmp_path: Path) -> None:
    script(
        tmp_path, "import sys\nsys.excepthook = lambda *error: 1 / 0\nraise ValueError('the first fault')\n", "hook.py"
    )
    script(tmp_path, "import time; time.sleep(2); print('done')", "whole.py")
    launch = script(
        tmp_path,
        "from launch import LaunchDescription\n"
        "from launch.actions import ExecuteProcess\n"
        "COMMANDS = ['sleep', '1'], ['python3', 'missing.py'], ['python3', 'hook.py'], ['python3', 'whole.py']\n"
        "def generate_launch_description():\n"
        "    return LaunchDescription([ExecuteProcess(cmd=cmd, output='screen') for cmd in COMMANDS])\n",
        "mistakes.launch.py",
    )
    result = run("ros2", "launch", launch, folder=tmp_path)
    output = result.stdout + result.stderr
    assert "in lock-step only programs of this Python run, cmd 'sleep 1'" in output
    assert f"can't open file '{tmp_path / 'missing.py'}': [Errno 2] No such file or directory" in output
    assert "exit code 2, cmd 'python3 missing.py'" in output
    assert "Error in sys.excepthook" in output
    assert "ValueError: the first fault" in output
    assert "exit code 1, cmd 'python3 hook.py'" in output
    assert "] done" in output
    assert run("sleep", "1", folder=tmp_path).returncode == 1


def test_a_bag_that_is_there_already_ends_the_run(tmp_path: Path) -> None:
    (tmp_path / "bag").mkdir()
    path = script(tmp_path, "import time; time.sleep(10); print('went on')")
    result = run(sys.executable, path, folder=tmp_path, options=Options(bag="bag"))
    assert result.returncode == 1
    assert "the recording to 'bag' ended with status" in result.stderr
    assert "went on" not in result.stdout


def test_a_deadlock_ends_the_run_with_the_stacks(tmp_path: Path) -> None:
    path = script(
        tmp_path,
        "import threading, time\n"
        "one, other = threading.Lock(), threading.RLock()\n"
        "def left():\n"
        "    with one:\n"
        "        time.sleep(1)\n"
        "        with other: pass\n"
        "def right():\n"
        "    with other:\n"
        "        time.sleep(1)\n"
        "        with one: pass\n"
        "threads = [threading.Thread(target=f, name=f.__name__) for f in (left, right)]\n"
        "[thread.start() for thread in threads]\n"
        "[thread.join() for thread in threads]\n",
    )
    result = run(sys.executable, path, folder=tmp_path)
    assert result.returncode == 1
    assert "the run cannot go on at 1 s: 2 thread(s) wait for each other for ever" in result.stderr
    assert "(left) waits for a lock that program.py (right) has:" in result.stderr
    assert "in left" in result.stderr


def test_a_program_that_waits_for_nothing_is_reported(tmp_path: Path) -> None:
    path = script(tmp_path, "import threading\nthreading.Event().wait()\n")
    result = run(sys.executable, path, folder=tmp_path)
    assert result.returncode == 1
    assert "nothing is left to happen; every thread waits" in result.stderr
    assert "program.py (MainThread) waits for a condition or event:" in result.stderr
    assert "threading.Event().wait()" in result.stderr


CALLER = """
import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from std_srvs.srv import Trigger

rclpy.init()
nodes = [rclpy.create_node(name) for name in ("left", "right")]
executor = MultiThreadedExecutor(4)
for node, other in zip(nodes, ("right", "left")):
    group = MutuallyExclusiveCallbackGroup()
    client = node.create_client(Trigger, f"ask_{other}", callback_group=MutuallyExclusiveCallbackGroup())
    answer = lambda request, response, client=client: client.call(Trigger.Request())
    node.create_service(Trigger, f"ask_{node.get_name()}", answer, callback_group=group)
    executor.add_node(node)
ask = nodes[0].create_client(Trigger, "ask_right")
ask.wait_for_service()
ask.call_async(Trigger.Request())
executor.spin()
"""


@pytest.mark.parametrize("until_s", [None, 15.0])
def test_nodes_that_wait_for_each_other_are_named(tmp_path: Path, until_s: float | None) -> None:
    result = run(sys.executable, script(tmp_path, CALLER), folder=tmp_path, options=Options(until_s=until_s))
    for other in ("left", "right"):
        assert f"for the answer of /{other} to a call of the service '/ask_{other}'" in result.stderr


@pytest.mark.parametrize(
    ("body", "status"),
    [
        ("raise SystemExit(3)", 3),
        ("1 / 0", 1),
        ("import time; time.sleep(100)", 130),
        ("import signal, time; signal.signal(2, lambda n, f: exit(7)); time.sleep(100)", 7),
    ],
)
def test_the_exit_status_is_the_programs(tmp_path: Path, body: str, status: int) -> None:
    path = script(tmp_path, body)
    result = run(sys.executable, path, folder=tmp_path, options=Options(until_s=5.0))
    assert result.returncode == status, result.stderr
    assert "daidalos" not in result.stderr  # the frames of a traceback are the user's own


@pytest.mark.slow
def test_ros2_launch_takes_the_options(tmp_path: Path) -> None:
    launch = script(tmp_path, GRAPH, "graph.launch.py")
    command = [sys.executable, "-m", "daidalos.cli.ros2", "launch", str(launch), "--lockstep", "--until", "2"]
    environment = os.environ | {"ROS_HOME": str(tmp_path)}
    result = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120, check=False)
    assert result.returncode == 0, result.stderr
    assert "[1577836801.000000000] [listener]: I heard: [Hello World: 0]" in result.stdout + result.stderr
    assert "[lockstep] the run ends at 2 s" in result.stderr
    assert "interrupted" not in result.stdout + result.stderr


@pytest.mark.slow
def test_sockets_hand_on_and_what_follows_the_real_time_is_named(tmp_path: Path) -> None:
    path = script(
        tmp_path,
        "import os, random, select, signal, socket, subprocess, sys, threading, time, uuid\n"
        "ours, theirs = socket.socketpair()\n"
        "begun = time.time()\n"
        "def peer():\n"
        "    time.sleep(1.0)\n"
        "    theirs.sendall(b'hello')\n"
        "threading.Thread(target=peer).start()\n"
        "print(ours.recv(100), round(time.time() - begun, 1))\n"
        "ours.settimeout(0.5)\n"
        "try:\n"
        "    ours.recv(1)\n"
        "except TimeoutError:\n"
        "    print('nothing', round(time.time() - begun, 1))\n"
        "print(select.select([ours], [], [], 2.5), round(time.time() - begun, 1))\n"
        "polled = select.poll()\n"
        "polled.register(ours, select.POLLIN)\n"
        "print(polled.poll(1500), round(time.time() - begun, 1))\n"
        "print(time.clock_gettime(time.CLOCK_REALTIME) - time.time(), os.times().elapsed - time.monotonic(), "
        "uuid.uuid1(), random.Random().random())\n"
        "signal.alarm(0)\n"
        "subprocess.run([sys.executable, '-c', ''])\n",
    )
    first, second = (run(sys.executable, path, folder=tmp_path) for _ in range(2))
    assert first.returncode == 0, first.stderr
    *lines, identifier = first.stdout.splitlines()
    assert lines == ["b'hello' 1.0", "nothing 1.5", "([], [], []) 4.0", "[] 5.5"]
    assert identifier.startswith("0.0 0.0 ")
    assert first.stdout == second.stdout
    for line, what in (
        (8, "socket.recv"),
        (11, "socket.recv"),
        (14, "select.select"),
        (17, "select.poll"),
        (19, "signal.alarm"),
        (20, "subprocess.Popen"),
    ):
        expected = f"[lockstep] {path}:{line}: {what} of program.py follows the real time; from here on runs may differ"
        assert expected in first.stderr.splitlines()

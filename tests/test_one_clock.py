"""Code of robots reads the time of its node's clock only, so that simulated time can be stepped."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from places import REPOSITORY

LAYERS = (
    "description", "samples", "simulation", "control", "mapping", "localization", "navigation", "industry", "nodes",
)  # fmt: skip
OTHER_CLOCKS = {
    "time": {"monotonic", "monotonic_ns", "perf_counter", "perf_counter_ns", "sleep", "time", "time_ns"},
    "asyncio": {"sleep", "wait_for"},
    "threading": {"Timer"},
    "datetime": {"now", "today", "utcnow"},
    "ClockType": {"STEADY_TIME", "SYSTEM_TIME"},
}
ALLOWED = {
    "industry/assistance/laser_projector.py": "the time stamps of frames, which a projector expects in real time",
    "industry/egm/client.py": "how long a controller is silent, and the time stamp of guidance",
    "industry/egm/controller_server.py": "the cycle of a controller, which does not wait",
    "industry/lighting/device.py": "how long a broker is lost, and how often the state is published",
    "industry/lighting/embedded_broker.py": "one turn of an event loop at its end",
    "industry/lighting/engine.py": "the pace of DMX frames, which lamps expect in real time",
    "industry/rapid/debugging/session.py": "the braking of a program that is debugged in real time",
    "industry/rapid/runtime/pacing.py": "the pace of programs in real time",
    "industry/rsi/client.py": "how long a robot is silent, and the computing time that is reported",
    "industry/rsi/controller_server.py": "the cycle of a controller, which does not wait",
    "industry/rws/certificate.py": "when a certificate begins to hold",
    "industry/rws/controller.py": "how long a program that computes is waited for",
    "industry/rws/server.py": "how often changes are looked for that are sent over a web socket",
    "industry/servoing/experiments.py": "cycles in real time, where they are asked for",
    "industry/welding/rapid_paths.py": "the computing time of a program that may be endless",
    "navigation/planners/search.py": "the computing time of a search, which max_planning_time limits",
    "nodes/abb_hardware_interface/_hardware.py": "how long a controller is waited for",
    "nodes/asset_folders.py": "the age of a file",
    "nodes/daidalos_demo/_measuring.py": "the computing time of other processes",
    "nodes/daidalos_demo/_robot.py": "when to ask again whether other processes are up",
    "nodes/daidalos_rapid/rapid_pendant.py": "the date that programs read",
    "nodes/gazebo_ros/_pacing.py": "the pace of simulated time in real time",
    "nodes/gazebo_ros/gzserver.py": "the report of how fast simulated time passes, once a second of real time",
    "nodes/gazebo_ros/spawn_entity.py": "how long a person waits for a simulator whose time may stand still",
    "nodes/graph_parameters.py": "how long a client of the page waits for silent nodes",
    "nodes/hector_mapping/hector_mapping.py": "the computing time of a scan, where output_timing asks for it",
    "nodes/joy/_node.py": "when to look for a device again",
    "nodes/keyboard.py": "how long a person has to press a key",
    "nodes/kuka_kss_rsi_driver/_hardware.py": "how long a robot is waited for",
    "nodes/mqtt_client/_bridges.py": "the times of sending and arrival, which the latency is computed from",
    "nodes/nav2_lifecycle_manager/_server_watch.py": "whether a process answers, in real time",
    "nodes/nav2_planner/planner_server.py": "the computing time that the result of a plan reports",
    "nodes/nav2_route/route_server.py": "the computing time that is limited and reported",
    "nodes/nav2_smoother/smoother_server.py": "duration of smoothing",
    "nodes/ros_gz_sim/create.py": "how long a person waits for a simulator whose time may stand still",
    "nodes/rosbridge_server/_server.py": "the pace at which a client wants its messages",
    "nodes/rosbridge_server/rosbridge_websocket.py": "when to try a used port again",
    "nodes/slam_toolbox/_slam_toolbox.py": "start and waiting scans while simulated time stands still",
    "nodes/studio_window.py": "how long a browser is given to end",
    "nodes/tf2_tools/view_frames.py": "the name of a file",
    "nodes/topic_tools/delay.py": "real time where the parameter use_wall_clock asks for it",
    "nodes/topic_tools/throttle.py": "real time where the parameter use_wall_clock asks for it",
    "nodes/warming.py": "how long a person waits for the compiler",
    "simulation/conversion/preparation.py": "how long a person waits for a world to be loaded",
}
"""Files under `src/daidalos` that may read another clock, and what for."""


_MAYBE = re.compile(
    "|".join([rf"{owner}\.({'|'.join(names)})|from {owner} " for owner, names in OTHER_CLOCKS.items()] + [r"wait\("])
)


def uses(source: str) -> Iterator[str]:
    """Yield ``line: name`` of each use of another clock: its functions, and waits that end by themselves."""
    if not _MAYBE.search(source):
        return
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            if node.attr in OTHER_CLOCKS.get(node.value.id, ()):
                yield f"{node.lineno}: {node.value.id}.{node.attr}"
        elif isinstance(node, ast.ImportFrom):
            for name in {alias.name for alias in node.names} & OTHER_CLOCKS.get(node.module or "", set()):
                yield f"{node.lineno}: {node.module}.{name}"
        elif isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "wait" and (node.args or node.keywords):
            yield f"{node.lineno}: wait with a timeout"


def test_no_code_of_robots_reads_another_clock() -> None:
    root = REPOSITORY / "src/daidalos"
    found = {
        path.relative_to(root).as_posix(): list(uses(path.read_text(encoding="utf-8")))
        for layer in LAYERS
        for path in Path(root / layer).rglob("*.py")
    }
    using = {name: lines for name, lines in found.items() if lines}
    assert {name: lines for name, lines in using.items() if name not in ALLOWED} == {}
    assert set(ALLOWED) == set(using), "these read no other clock any more"


def test_uses_are_found() -> None:
    source = "import time\nfrom time import sleep\ntime.monotonic()\nevent.wait(1.0)\nevent.wait()\nnode.time()\n"
    assert sorted(uses(source)) == ["2: time.sleep", "3: time.monotonic", "4: wait with a timeout"]

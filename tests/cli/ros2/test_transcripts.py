"""Every command of which it is known what ROS 2 prints is run, and what it prints is compared."""

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from domains import reserved_domain

from .commands import Result, environment, ros2

pytestmark = pytest.mark.slow

_SHARED = Path(os.environ.get("DAIDALOS_SHARED_DATA", Path(__file__).parents[4] / "shared" / "data"))
_FILE = _SHARED / "cli" / "transcripts.json"
TRANSCRIPTS = json.loads(_FILE.read_text()) if _FILE.is_file() else []

PARAMETERS = "/talker:\n  ros__parameters:\n    speed: 2.0\n    names: [c, d]\n    gains: {p: 0.2}\n"
WILDCARD_PARAMETERS = "/**:\n  ros__parameters:\n    speed: 1.0\n"

DIFFERENT = {
    # ROS 2 prints nonsense or nothing, or crashes; the modules beside this one test what we do.
    "topic echo --once --qos-durability transient_local /tf_static": "best effort gets what was latched, too",
    "topic pub --once /new std_msgs/msg/Int8 data: 300": "fails at once",
    "topic pub --once /cmd_vel geometry_msgs/msg/Twist {linear: [}": "says where the YAML is wrong",
    "topic type --no-daemon /nothing": "names the topic",
    "action info /lab/fibonacci": "names the server",
    "action info -t /lab/fibonacci": "names the server",
    "action find example_interfaces/action/Fibonacci": "has the verb",
    "param load --no-daemon /talker missing.yaml": "says it in one line",
}


def _name(transcript: dict[str, Any]) -> str:
    return " ".join(transcript["command"][1:])


LANES = {"node": 0, "topic": 0, "service": 1, "param": 1, "action": 1, "daemon": 1}
"""Commands of one lane run one after another, beside nodes of their own: commands see each other's nodes."""
WAITING = 2


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory, shared_data: Path) -> Iterator[dict[int, Result]]:
    """The outcome of every command."""
    folder = tmp_path_factory.mktemp("commands")
    (folder / "p.yaml").write_text(PARAMETERS)
    (folder / "q.yaml").write_text(WILDCARD_PARAMETERS)
    program = [sys.executable, shared_data / "cli" / "nodes.py"]
    with ExitStack() as reserved:
        domains = [reserved.enter_context(reserved_domain()) for _ in range(4)]
        nodes = [subprocess.Popen(program, env=environment(domains[lane])) for lane in (0, 1, WAITING)]
        try:
            for lane in (0, 1, WAITING):
                _wait_for_nodes(domains[lane])
            started = ros2("daemon", "start", env=environment(domains[LANES["daemon"]]))  # transcripts find it running
            assert started.status == 0, started
            yield _run_all(folder, domains)
        finally:
            for process in nodes:
                process.terminate()
            for process in nodes:
                process.wait(10)


def _run_all(folder: Path, domains: list[int]) -> dict[int, Result]:
    jobs: dict[tuple[int, int], list[int]] = {}
    for number, transcript in enumerate(TRANSCRIPTS):
        waits = "interrupted_after_s" in transcript
        # Those that wait for Ctrl-C cost time but no work: they run side by side.
        job = (WAITING, number % 4) if waits else (LANES.get(transcript["command"][1], 3), 0)
        jobs.setdefault(job, []).append(number)
    found: dict[int, Result] = {}

    def run(job: tuple[int, int]) -> None:
        env = environment(domains[job[0]])
        for number in jobs[job]:
            transcript = TRANSCRIPTS[number]
            lines = None
            if "interrupted_after_s" in transcript:
                lines = min(transcript["stdout"].count("\n"), 4)
            found[number] = ros2(*transcript["command"][1:], env=env, cwd=folder, interrupt_after_lines=lines)

    with ThreadPoolExecutor(len(jobs)) as pool:
        list(pool.map(run, jobs))
    return found


def _wait_for_nodes(domain: int) -> None:
    import rclpy
    from rclpy.context import Context
    from rclpy.node import Node

    context = Context()
    rclpy.init(args=[], context=context, domain_id=domain)
    node = Node("_waiting", context=context)
    try:
        graph = node.handle.graph
        assert graph.wait_for(lambda: bool(graph.endpoints(name="/lab/fibonacci/_action/feedback")), 60)
    finally:
        node.destroy_node()
        context.destroy()


@pytest.mark.parametrize("number", range(len(TRANSCRIPTS)), ids=[_name(one) for one in TRANSCRIPTS])
def test_prints_what_ros2_prints(number: int, results: dict[int, Result]) -> None:
    transcript = TRANSCRIPTS[number]
    if _name(transcript) in DIFFERENT:
        pytest.skip(DIFFERENT[_name(transcript)])
    result = results[number]
    words = transcript["command"]
    assert _normalised(words, result.out) == _normalised(words, transcript["stdout"])
    # Where a name is wrong, we say which names are near, or which there are.
    err = re.sub(r"^(Did you mean|There are these) .*\n?", "", result.err, flags=re.MULTILINE)
    assert _normalised(words, err) == _normalised(words, transcript["stderr"])
    assert result.status == transcript["exit"]


def _normalised(words: list[str], text: str) -> list[str]:
    text = re.sub(r"_ros2cli_\d+", "_ros2cli_N", text.strip("\n"))
    text = re.sub(r"GID: [0-9a-f.]+", "GID: X", text)
    text = re.sub(r"with ID: [0-9a-f]{32}", "with ID: X", text)
    text = re.sub(r"Hello World: \d+", "Hello World: N", text)
    text = re.sub(r"'[^']*(/share/std_msgs/msg/Nope.idl)'", r"'<prefix>\1'", text)
    text = re.sub(r"maintainer: \[.*\]", "maintainer: X", text)
    text = re.sub(r"destination directory: .*", "destination directory: X", text)
    lines = text.split("\n")
    if words[1:3] == ["node", "list"]:
        lines.sort()
    if words[1:3] in (["topic", "hz"], ["topic", "bw"], ["topic", "delay"]):
        lines = [re.sub(r"\d+(\.\d+)?", "N", line) for line in lines][: 3 if "bw" in words else 2]
    if "--raw" in words:
        # The other middleware pads to four bytes.
        lines = [re.sub(r"(\\x00)+'$", "'", line) for line in lines]
        lines = [re.sub(r"\\x11\\x00\\x00\\x00", r"\\x10\\x00\\x00\\x00", line) for line in lines]
    if words[1:3] == ["topic", "echo"] and "--no-str" in words:
        lines = [re.sub(r"<\d+>", "<N>", line) for line in lines]
    if words[1:3] == ["pkg", "prefix"] and len(lines) == 1 and "not found" not in text:
        lines = ["<prefix>"]
    if "version" in words:
        lines = [re.sub(r"\d+", "N", line) for line in lines]
    if words[1:3] == ["interface", "packages"]:
        lines = [line for line in lines if line in _THEIR_PACKAGES]
    if words[1] == "nope":
        lines = [re.sub(r"choose from .*", "choose from X", line) for line in lines]
    if "interrupted" in text or (words[1:3] == ["service", "call"] and "-r" in words):
        lines = lines[:4]
    if words[1:3] == ["topic", "pub"] and "Waiting for" in text:
        lines = lines[:2]
    return lines


_THEIR_PACKAGES = next((one["stdout"].split() for one in TRANSCRIPTS if _name(one) == "interface packages"), [])

"""Two lock-step runs of five minutes of mapping and navigation: whether their bags are alike, bit for bit.

Each is a process whose hashes of strings differ from the other's, as those of Python do from run to run.
"""

from __future__ import annotations

import hashlib
import json
import sys
import tempfile
from pathlib import Path

from benchmarks.runs import ENVIRONMENT, Cost, measure
from daidalos.lockstep.options import Options

GOALS = 22
"""Which take a little more than five simulated minutes."""


def run() -> dict[str, float | str]:
    """Drive twice, and compare the bags."""
    with tempfile.TemporaryDirectory() as name:
        folders = [Path(name) / str(number) for number in (1, 2)]
        costs = [drive(folder) for folder in folders]
        bags = [digests(folder / "bag") for folder in folders]
        lines = [line for line in costs[0].output.splitlines() if line.startswith('{"goals"')]
        report = json.loads(lines[-1])
        seconds = duration_s(folders[0] / "bag")
    return {
        "determinism.bags_alike": float(bags[0] == bags[1]),
        "determinism.sha256": bags[0]["bag_0.mcap"],
        "determinism.goals_reached": sum(goal["reached"] for goal in report["goals"]),
        "determinism.contacts": report["contacts"],
        "determinism.simulated_s": seconds,
        "determinism.times_real_time": seconds / costs[0].seconds,
        "determinism.peak_mb": max(cost.peak_mb for cost in costs),
    }


def drive(folder: Path) -> Cost:
    """Drive to all goals in lock-step, with a bag in a folder of its own, whose name is the seed of Python's hashes."""
    folder.mkdir()
    words = Options(seed=1, bag="bag", exclude="^/camera/").words()
    start = [sys.executable, "-m", "daidalos.lockstep.start", *words, "--"]
    demo = ["daidalos", "demo", "--headless", "--seed", "1", "--goals", str(GOALS), "--json"]
    hashes = {"PYTHONHASHSEED": folder.name, "ROS_HOME": str(folder / "ros")}
    return measure([*start, *demo], folder, ENVIRONMENT | hashes)


def digests(bag: Path) -> dict[str, str]:
    """Return the SHA-256 of the files of a bag by name."""
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(bag.iterdir())}


def duration_s(bag: Path) -> float:
    """Return how long a bag is [s]."""
    from daidalos.bags.metadata import read_metadata

    return read_metadata(bag).duration_ns * 1e-9

"""How long worlds and robots take to load the first time and the second: `python -m benchmarks.loading FOLDER ...`.

`DAIDALOS_PUBLIC_MODELS` names the folder (or several, with a colon between) for `python -m benchmarks loading`. Worlds
find what they include in the folders called ``models`` below them.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

import psutil

from benchmarks.description import public_files

MODEL_PATH = "GZ_SIM_RESOURCE_PATH"


@dataclass(frozen=True)
class Load:
    """Loading of a file into the simulator by a new process: real time and computing time [s], and why it failed."""

    real: float
    computing: float
    trouble: str


def run() -> dict[str, float]:
    """Measure the public worlds and robots; times in seconds."""
    folders = [Path(word) for word in os.environ.get("DAIDALOS_PUBLIC_MODELS", "").split(os.pathsep) if word]
    if not folders:
        print("DAIDALOS_PUBLIC_MODELS names no folder: no public worlds", file=sys.stderr)
    loads = [(first, second) for _, first, second in measure(folders, show=sys.stderr) if not first.trouble]
    if not loads:
        return {}
    return {
        "loading.first_slowest_s": max(first.real for first, _ in loads),
        "loading.second_slowest_s": max(second.real for _, second in loads),
        "loading.first_computing_slowest_s": max(first.computing for first, _ in loads),
    }


def measure(folders: list[Path], show: TextIO | None = None) -> Iterator[tuple[Path, Load, Load]]:
    """Load each world and robot below folders twice, the first time with an empty cache; print and yield the times."""
    print(f"{'first':>8} {'(CPU)':>8} {'second':>8} {'(CPU)':>8}  file", file=show)
    places = os.pathsep.join(str(place) for folder in folders for place in folder.rglob("models") if place.is_dir())
    for file in sorted(file for folder in folders for file in public_files(folder, (".world", ".sdf", ".urdf"))):
        is_world = b"<world" in file.read_bytes()
        if not is_world and file.suffix != ".urdf":
            continue
        with tempfile.TemporaryDirectory() as cache:
            environment = os.environ | {"DAIDALOS_CACHE": cache, MODEL_PATH: places}
            first, second = (load(file, is_world, environment) for _ in range(2))
        numbers = f"{first.real:8.2f} {first.computing:8.2f} {second.real:8.2f} {second.computing:8.2f}"
        print(f"{numbers}  {file}{f': {first.trouble}' if first.trouble else ''}", file=show, flush=True)
        yield file, first, second


def load(file: Path, is_world: bool, environment: dict[str, str]) -> Load:
    """Load a file in a process of its own."""
    words = [str(file)] if is_world else ["--model", str(file)]
    command = [sys.executable, "-m", "daidalos.cli.daidalos", "sim", "--duration", "0.01", *words]
    begun, before = time.perf_counter(), _children_time()
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    real, computing = time.perf_counter() - begun, _children_time() - before
    lines = done.stderr.strip().splitlines() or [f"ended with {done.returncode}"]
    return Load(real, computing, lines[-1] if done.returncode else "")


def _children_time() -> float:
    times = psutil.Process().cpu_times()
    return float(times.children_user + times.children_system)


if __name__ == "__main__":
    sys.exit(0 if list(measure([Path(word) for word in sys.argv[1:]])) else "name folders with worlds or robots")

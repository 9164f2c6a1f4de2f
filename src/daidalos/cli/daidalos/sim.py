"""`daidalos sim`: simulation of a world with robots, with a view in the browser."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.workspaces.executables import built_in_command

if TYPE_CHECKING:
    from launch_ros.actions import Node

    from daidalos.description.robot import Robot
    from daidalos.description.world import Model

EPILOG = """The world is an SDF file, or the name of one in a package (arena, hexagon); without one it is empty.
With --headless nothing but the simulation runs; with --duration it runs as fast as it can, for so long in simulated
time, and says how fast that was."""


class SimVerb:
    """Simulate a world."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of `daidalos sim`."""
        parser.epilog = EPILOG
        parser.add_argument("world", nargs="?", default="", help="an SDF file, or the name of a world")
        parser.add_argument(
            "-m", "--model", action="append", default=[], metavar="FILE", help="a robot or model to spawn"
        )
        parser.add_argument("--pause", action="store_true", help="begin with time standing still")
        parser.add_argument("--headless", action="store_true", help="without the studio")
        parser.add_argument(
            "--speed", type=float, metavar="FACTOR", help="0: as fast as possible; the world's by default"
        )
        parser.add_argument("--seed", type=int, default=0, help="of all random numbers")
        parser.add_argument("--port", type=int, default=8765, help="of the studio")
        parser.add_argument(
            "--duration", type=float, metavar="S", help="simulate so long, then end; no graph, no studio"
        )

    def main(self, *, args: argparse.Namespace) -> int:
        """Simulate; return the exit status."""
        from daidalos.description.errors import DescriptionError
        from daidalos.simulation.errors import SimulationError

        try:
            world = _find_world(args.world)
            if args.duration is not None:
                return _run_offline(world, args)
            return _launch(world, args)
        except (DescriptionError, SimulationError, OSError) as error:
            print(f"error: {error}", file=sys.stderr)
            return 2
        except KeyboardInterrupt:
            return 130


def _find_world(name: str) -> Path | None:
    """Return the file of a world; None for the empty world."""
    from daidalos.interfaces.library import BUILT_IN

    if not name:
        return None
    path = Path(name)
    if path.is_file():
        return path
    folder = BUILT_IN / "turtlebot3_gazebo" / "worlds"
    for candidate in (folder / name, folder / f"{name}.world"):
        if candidate.is_file():
            return candidate
    known = ", ".join(sorted(file.stem for file in folder.glob("*.world")))
    raise FileNotFoundError(f"there is no world file '{name}'; known by name are {known}")


def _run_offline(path: Path | None, args: argparse.Namespace) -> int:
    """Simulate without a graph, as fast as possible."""
    import time

    from daidalos.nodes.gazebo_ros._descriptions import read_world
    from daidalos.simulation import Simulation

    simulation = Simulation(
        read_world(path), args.seed, has_subscribers=lambda topic: False, warn=_warn, progress=_report_loading
    )
    for file in args.model:
        simulation.spawn(_read_model(Path(file)))
    begun = time.perf_counter()
    simulation.advance(round(args.duration * 1e9))
    elapsed = time.perf_counter() - begun
    simulated = simulation.time_ns * 1e-9
    print(f"simulated {simulated:g} s in {elapsed:.2f} s, real-time factor {simulated / max(elapsed, 1e-9):.1f}")
    for name in simulation.models:
        x, y, z = simulation.pose(name).position
        print(f"  {name}: {x:.3f} {y:.3f} {z:.3f}")
    return 0


def _read_model(path: Path) -> "Robot | Model":
    from daidalos.description import sdf, urdf
    from daidalos.nodes.packages import package_share

    return sdf.load_model(path, package_share) if path.suffix == ".sdf" else urdf.load(path, resolve=package_share)


def _report_loading(done: int, count: int) -> None:
    print(f"preparing the meshes of collisions, kept for the next start: {done} of {count}", file=sys.stderr)


def _warn(line: str) -> None:
    print(f"warning: {line}", file=sys.stderr)


def _launch(path: Path | None, args: argparse.Namespace) -> int:
    """Start the simulator, the spawners and the studio; stop them together."""
    from launch.actions import Shutdown

    from daidalos.cli.daidalos.launching import run_launch

    for file in args.model:
        _read_model(Path(file))  # a fault is better told before anything runs
    words = [*([str(path.resolve())] if path else []), *(["--pause"] if args.pause else [])]
    parameters = {"seed": args.seed} | ({} if args.speed is None else {"real_time_factor": float(args.speed)})
    server = _built_in_node("gazebo_ros", "gzserver", words, [parameters], on_exit=[Shutdown()])
    spawners = [
        _built_in_node(
            "gazebo_ros",
            "spawn_entity.py",
            ["-file", str(Path(file).resolve()), "-entity", Path(file).name.partition(".")[0]],
        )
        for file in args.model
    ]
    studio = _built_in_node(
        "foxglove_bridge",
        "foxglove_bridge",
        parameters=[{"port": args.port, "open_browser": True, "front": "simulation"}],
    )
    return run_launch(server, *spawners, *([] if args.headless else [studio]))


def _built_in_node(
    package: str, executable: str, arguments: Sequence[str] = (), parameters: Sequence[Any] = (), **kwargs: Any
) -> "Node":
    """Return the action that starts a built-in node, even where a sourced workspace has a package of that name."""
    from launch_ros.actions import Node

    program, *beginning = built_in_command(package, executable)
    return Node(
        executable=program,
        arguments=[*beginning, *arguments],
        parameters=list(parameters) or None,
        exec_name=executable,
        output="screen",
        **kwargs,
    )

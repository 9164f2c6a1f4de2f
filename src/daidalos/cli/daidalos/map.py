"""`daidalos map`: map and trajectory from the log of a real robot."""

import argparse
import contextlib
import json
import os
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from daidalos.common.errors import UserError

if TYPE_CHECKING:
    from daidalos.mapping.evaluation import RelationErrors, Relations
    from daidalos.mapping.log import Log
    from daidalos.mapping.offline import LogMap

EPILOG = """The bag is an MCAP or sqlite3 bag with scans (sensor_msgs/LaserScan) and odometry
(nav_msgs/Odometry, or the transform odom -> base in /tf). NAME.pgm and NAME.yaml are written as map_server
reads them."""


class MapVerb:
    """Build a map from the log of a robot."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of `daidalos map`."""
        parser.epilog = EPILOG
        parser.add_argument("bag", type=Path, help="bag: a folder, an .mcap or a .db3 file")
        parser.add_argument(
            "-o",
            "--output",
            type=Path,
            metavar="NAME",
            help="write NAME.pgm and NAME.yaml (default: the bag's name)",
        )
        parser.add_argument(
            "--resolution",
            type=_positive,
            default=0.05,
            metavar="M",
            help="side of a cell in metres (default: 0.05)",
        )
        parser.add_argument(
            "--max-range",
            type=_positive,
            default=20.0,
            metavar="M",
            help="longest range that is used in metres (default: 20)",
        )
        parser.add_argument(
            "--mode",
            choices=("trinary", "raw"),
            default="trinary",
            help="what the grey values mean (default: trinary)",
        )
        parser.add_argument("--scan-topic", metavar="TOPIC", help="topic of the scans (default: /scan or the only one)")
        parser.add_argument(
            "--odom-topic", metavar="TOPIC", help="topic of the odometry (default: /odom or the only one)"
        )
        parser.add_argument(
            "--relations", type=Path, metavar="FILE", help="ground-truth relations to print the error against"
        )
        parser.add_argument("--trajectory", type=Path, metavar="FILE", help="write the trajectory in TUM format")
        parser.add_argument("--json", action="store_true", help="print one JSON object")

    def main(self, *, args: argparse.Namespace) -> int:
        """Map a log; return the exit status."""
        report = _run(args)
        print(json.dumps(report) if args.json else _as_text(report))
        return 0


def _run(args: argparse.Namespace) -> dict[str, Any]:
    from daidalos.mapping.evaluation import read_relations
    from daidalos.mapping.log import read_log
    from daidalos.mapping.map_file import save_map

    output: Path = args.output or Path(args.bag.resolve().stem)
    _require_writable(output)
    if args.trajectory:
        _require_writable(args.trajectory)
    relations = read_relations(args.relations) if args.relations else None
    log = read_log(args.bag, scan_topic=args.scan_topic, odom_topic=args.odom_topic)
    if relations is not None:
        raw_errors = _errors(args.relations, log.odometry_stamps_ns, log.all_odometry, relations)
    mapped, seconds = _map(log, args)
    if mapped.grid.data.size == 0:
        raise UserError(f"{args.bag}: no scan on {log.scan_topic} has enough valid ranges to map")
    written = list(save_map(mapped.grid, output, args.mode))
    if args.trajectory:
        _write_trajectory(args.trajectory, mapped)
        written.append(args.trajectory)
    report = _report(log, mapped, seconds, written)
    if relations is not None:
        from daidalos.mapping.evaluation import clock_offset, shifted

        trajectory = mapped.trajectory_ns, mapped.trajectory
        report["odometry_error"] = raw_errors.summary()
        report["slam_error"] = _errors(args.relations, *trajectory, relations).summary()
        offset = clock_offset(*trajectory, relations)
        report["clock_offset_s"] = offset
        report["slam_error_with_clock_offset"] = _errors(
            args.relations, *trajectory, shifted(relations, offset)
        ).summary()
    return report


def _map(log: "Log", args: argparse.Namespace) -> tuple["LogMap", float]:
    """Return the map and the computing time [s], without compilation of the kernels."""
    from daidalos.common.kernels import warm_up
    from daidalos.mapping.offline import map_log
    from daidalos.mapping.slam import SlamConfig

    config = SlamConfig(
        resolution=args.resolution,
        max_laser_range=args.max_range,
        minimum_travel_distance=0.3,
        minimum_travel_heading=0.3,
    )
    with _progress_bar(len(log.scans)) as (prepare, advance):
        warm_up("daidalos.mapping", prepare)
        start = time.perf_counter()
        mapped = map_log(log, config, advance)
        return mapped, time.perf_counter() - start


@contextlib.contextmanager
def _progress_bar(total: int) -> Iterator[tuple[Callable[[float, str], None], Callable[[int], None]]]:
    """Return two callbacks that show the preparation and the processed scans if stderr is a terminal."""
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    console = Console(stderr=True)
    with Progress(*columns, console=console, transient=True, disable=not sys.stderr.isatty()) as bar:
        preparing = bar.add_task("preparing", total=100)
        scans = bar.add_task("mapping", total=total, visible=False)

        def prepare(share: float, step: str) -> None:
            bar.update(preparing, completed=round(100 * share), description=f"preparing {step}", visible=share < 1.0)
            bar.update(scans, visible=share >= 1.0)

        def advance(done: int) -> None:
            if done % 20 == 0 or done == total:
                bar.update(scans, completed=done, description="mapping" if done < total else "refining")

        yield prepare, advance


def _errors(path: Path, stamps_ns: Any, poses: Any, relations: "Relations") -> "RelationErrors":
    from daidalos.mapping.evaluation import relation_errors

    try:
        return relation_errors(stamps_ns, poses, relations)
    except ValueError as error:
        raise UserError(f"{path}: {error}") from error


def _write_trajectory(path: Path, mapped: "LogMap") -> None:
    """Write a trajectory in TUM format: time x y z qx qy qz qw."""
    import numpy as np

    lines = [
        f"{stamp // 10**9}.{stamp % 10**9:09d} {x:.6f} {y:.6f} 0 0 0 {np.sin(yaw / 2):.9f} {np.cos(yaw / 2):.9f}\n"
        for stamp, (x, y, yaw) in zip(mapped.trajectory_ns.tolist(), mapped.trajectory, strict=True)
    ]
    try:
        path.write_text("".join(lines), encoding="ascii")
    except OSError as error:
        raise UserError(f"{path}: {error.strerror}") from error


def _report(log: "Log", mapped: "LogMap", seconds: float, written: list[Path]) -> dict[str, Any]:
    duration = float(log.stamps_ns[-1] - log.stamps_ns[0]) * 1e-9
    return {
        "files": [str(path) for path in written],
        "columns": mapped.grid.data.shape[1],
        "rows": mapped.grid.data.shape[0],
        "resolution": mapped.grid.resolution,
        "scans": len(log.scans),
        "scan_topic": log.scan_topic,
        "odometry": log.odometry_source,
        "key_scans": mapped.key_scans,
        "closures": mapped.closures,
        "log_s": duration,
        "seconds": seconds,
        "real_time_factor": duration / seconds,
    }


def _as_text(report: dict[str, Any]) -> str:
    lines = [
        f"{report['scans']} scans ({report['log_s']:.0f} s of log) mapped in {report['seconds']:.1f} s, "
        f"{report['real_time_factor']:.0f} times real time; {report['key_scans']} key scans, "
        f"{report['closures']} loop closures",
        f"{', '.join(report['files'])}: {report['columns']} x {report['rows']} cells of {report['resolution']:g} m",
    ]
    after = f"slam, clocks {report.get('clock_offset_s', 0.0):+.2f} s apart"
    kinds = (("odometry", "odometry_error"), ("slam", "slam_error"), (after, "slam_error_with_clock_offset"))
    for name, key in kinds:
        if key in report:
            error = report[key]
            lines.append(
                f"error of {name + ':':<9} translation {error['translation_mean_m']:.4f} +- "
                f"{error['translation_std_m']:.4f} m (median {error['translation_median_m']:.4f}), "
                f"rotation {error['rotation_mean_deg']:.3f} +- {error['rotation_std_deg']:.3f} deg "
                f"over {error['relations']} relations"
            )
    return "\n".join(lines)


def _require_writable(path: Path) -> None:
    """Raise an error at once if a result could not be written later."""
    if not path.parent.is_dir():
        raise UserError(f"{path}: no such folder: {path.parent}")
    if path.is_dir() or not os.access(path.parent, os.W_OK):
        raise UserError(f"{path}: cannot be written")


def _positive(text: str) -> float:
    value = float(text)
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"expected a number of metres above 0, found {text!r}")
    return value

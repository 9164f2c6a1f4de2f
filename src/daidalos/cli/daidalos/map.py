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
(nav_msgs/Odometry, or the transform odom -> base in /tf), or a log of CARMEN (.log, .clf). NAME.pgm and
NAME.yaml are written as map_server reads them. Trajectories are files in the format of TUM or KITTI
(.kitti), logs of CARMEN, pose graphs (.g2o) and, to compare with, bags, whose odometry is taken."""


class MapVerb:
    """Build a map from the log of a robot."""

    def add_arguments(self, parser: argparse.ArgumentParser, cli_name: str) -> None:
        """Declare the arguments of `daidalos map`."""
        parser.epilog = EPILOG
        parser.add_argument("bag", type=Path, nargs="?", help="bag: a folder, an .mcap or .db3 file; or a .log or .clf")
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
        parser.add_argument(
            "--trajectory",
            type=Path,
            metavar="FILE",
            help="write the trajectory: .kitti, .log and .clf (with scans), .g2o (the pose graph), else TUM's format",
        )
        parser.add_argument(
            "--compare",
            type=Path,
            nargs=2,
            metavar=("A", "B"),
            help="print the errors of trajectory A against B, which may be .relations, or of map A.yaml against B.yaml",
        )
        parser.add_argument(
            "--delta",
            type=_positive,
            default=1.0,
            metavar="M",
            help="distance of relative errors in metres (default: 1)",
        )
        parser.add_argument("--json", action="store_true", help="print one JSON object")

    def main(self, *, args: argparse.Namespace) -> int:
        """Map a log, or compare; return the exit status."""
        if (args.bag is None) == (args.compare is None):
            raise UserError("expected a bag to be mapped, or --compare A B")
        if args.compare is not None:
            first, second = args.compare
            report = _compare(first, second, args.delta)
            print(json.dumps(report) if args.json else _comparison_text(report))
            return 0
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
        _write_trajectory(args.trajectory, log, mapped)
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


def _write_trajectory(path: Path, log: "Log", mapped: "LogMap") -> None:
    """Write a trajectory in the format of its suffix."""
    from daidalos.mapping.carmen_log import CARMEN_SUFFIXES, write_carmen
    from daidalos.mapping.g2o_file import write_g2o
    from daidalos.mapping.trajectory import Trajectory
    from daidalos.mapping.trajectory_file import write_trajectory

    suffix = path.suffix.lower()
    if suffix in CARMEN_SUFFIXES:
        write_carmen(path, log.stamps_ns, log.scans, mapped.poses, log.odometry)
    elif suffix == ".g2o":
        write_g2o(path, mapped.key_poses, mapped.edges)
    else:
        write_trajectory(path, Trajectory(mapped.trajectory_ns, mapped.trajectory))


def _compare(first: Path, second: Path, delta: float) -> dict[str, Any]:
    """Return the errors of one trajectory or map against another."""
    from daidalos.mapping.comparison import compare_trajectories, compare_with_relations
    from daidalos.mapping.evaluation import compare_with_truth, read_relations
    from daidalos.mapping.trajectory_file import read_trajectory

    if {first.suffix, second.suffix} & {".yaml", ".yml"}:
        from daidalos.mapping.map_file import load_map

        agreement = compare_with_truth(load_map(first), load_map(second))
        return {"walls_found": agreement.walls_found, "walls_true": agreement.walls_true}
    estimated = read_trajectory(first)
    try:
        if second.suffix == ".relations":
            errors, offset = compare_with_relations(estimated, read_relations(second))
            return {"relations": errors.summary(), "clock_offset_s": offset}
        return compare_trajectories(estimated, read_trajectory(second), delta).summary()
    except ValueError as error:
        raise UserError(f"{first}, {second}: {error}") from error


def _comparison_text(report: dict[str, Any]) -> str:
    if "walls_found" in report:
        return (
            f"{100 * report['walls_found']:.1f} % of the second map's walls are in the first, "
            f"{100 * report['walls_true']:.1f} % of the first map's walls are in the second (within two cells)"
        )
    clocks = f"clocks: the second is {report['clock_offset_s']:+.2f} s ahead, which is taken out"
    if "relations" in report:
        return f"relations: {_errors_text(report['relations'])}\n{clocks}"
    return "\n".join(
        (
            f"ATE over {report['poses']} poses, aligned: rmse {report['ate_rmse_m']:.4f} m, "
            f"mean {report['ate_mean_m']:.4f}, median {report['ate_median_m']:.4f}, max {report['ate_max_m']:.4f}; "
            f"heading mean {report['heading_mean_deg']:.3f} deg, max {report['heading_max_deg']:.3f}",
            f"RPE over {report['rpe_delta_m']:g} m: {_errors_text(report['rpe'])}",
            clocks,
        )
    )


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
            lines.append(f"error of {name + ':':<9} {_errors_text(report[key])}")
    return "\n".join(lines)


def _errors_text(error: dict[str, float]) -> str:
    return (
        f"translation {error['translation_mean_m']:.4f} +- {error['translation_std_m']:.4f} m "
        f"(median {error['translation_median_m']:.4f}), rotation {error['rotation_mean_deg']:.3f} +- "
        f"{error['rotation_std_deg']:.3f} deg over {error['relations']} relations"
    )


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

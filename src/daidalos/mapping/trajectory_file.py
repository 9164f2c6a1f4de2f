"""Files of trajectories: which format a file has, by its name or what it holds."""

from pathlib import Path

from daidalos.mapping import carmen_log, g2o_file, kitti_file, tum_file
from daidalos.mapping.errors import GraphFileError
from daidalos.mapping.log import read_log
from daidalos.mapping.text_file import format_suffix, read_lines
from daidalos.mapping.trajectory import Trajectory

BAG_SUFFIXES = (".mcap", ".db3")


def read_trajectory(path: str | Path) -> Trajectory:
    """Read a trajectory: TUM, KITTI, CARMEN's log, g2o, or the odometry of a bag.

    Lines of 8 numbers are TUM's (time, position, quaternion), lines of 12 are KITTI's (upper rows of a matrix).
    ``.g2o`` holds a pose graph; ``.log``, ``.clf`` and ``.carmen`` are CARMEN's, of which the scans' poses are read.

    Raises
    ------
    MappingError
        When it is none of them.
    """
    file = Path(path)
    suffix = format_suffix(file)
    if file.is_dir() or suffix in BAG_SUFFIXES:
        log = read_log(file)
        return Trajectory(log.odometry_stamps_ns, log.all_odometry)
    if suffix == ".g2o":
        return Trajectory(None, g2o_file.read_g2o(file)[0])
    if suffix in carmen_log.CARMEN_SUFFIXES:
        return carmen_log.read_carmen(file).trajectory
    lines = read_lines(file, GraphFileError)
    if not lines:
        raise GraphFileError(file, None, "no poses in the file")
    numbers = len(lines[0][1].replace(",", " ").split())
    if numbers == kitti_file.NUMBERS:
        return kitti_file.read_kitti(file)
    if numbers == tum_file.NUMBERS:
        return tum_file.read_tum(file)
    raise GraphFileError(file, lines[0][0], f"expected 8 numbers (TUM) or 12 (KITTI), found {numbers} words")


def write_trajectory(path: str | Path, trajectory: Trajectory) -> None:
    """Write a trajectory: KITTI's format for ``.kitti``, else TUM's.

    Raises
    ------
    GraphFileError
        When the file cannot be written, or TUM's format is asked for without times.
    """
    file = Path(path)
    (kitti_file.write_kitti if file.suffix.lower() == ".kitti" else tum_file.write_tum)(file, trajectory)

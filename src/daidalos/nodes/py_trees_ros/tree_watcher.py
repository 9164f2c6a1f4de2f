"""`py-trees-tree-watcher`: prints the snapshots of a behaviour tree."""

from __future__ import annotations

import argparse

from daidalos.nodes.runner import UserError, program_arguments, run_program

_TIMEOUT_S = 15.0


def main() -> int:
    """Run the program."""
    return run_program(_watch)


def _watch() -> None:
    import rclpy
    from py_trees_ros import exceptions
    from py_trees_ros.trees import SnapshotStream, Watcher, WatcherMode

    args = _parser().parse_args(program_arguments())
    rclpy.init()
    watcher = Watcher(
        topic_name=args.topic_name,
        namespace_hint=args.namespace_hint,
        parameters=SnapshotStream.Parameters(
            blackboard_data=args.blackboard_data, blackboard_activity=args.blackboard_activity
        ),
        mode=WatcherMode.SNAPSHOT if args.snapshot else WatcherMode.STREAM,
        statistics=args.statistics,
    )
    try:
        watcher.setup(_TIMEOUT_S)
    except (exceptions.NotFoundError, exceptions.MultipleFoundError, exceptions.TimedOutError) as error:
        raise UserError(f"there is no one tree to watch: {error}") from None
    try:
        while rclpy.ok() and not watcher.done:
            rclpy.spin_once(watcher.node)
    finally:
        watcher.shutdown()


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="py-trees-tree-watcher", description="Print the snapshots of a tree.")
    parser.add_argument("topic_name", nargs="?", help="topic of snapshots (default: a stream is opened)")
    parser.add_argument("-n", "--namespace-hint", help="text in the name of the tree, if there is more than one")
    parser.add_argument("-a", "--blackboard-activity", action="store_true", help="show what happens on the blackboard")
    parser.add_argument("-b", "--blackboard-data", action="store_true", help="show variables of visited behaviours")
    parser.add_argument("-s", "--statistics", action="store_true", help="show statistics of ticks")
    mode = parser.add_mutually_exclusive_group()
    mode.add_argument("--snapshot", "--snapshots", action="store_true", help="print one snapshot and end")
    mode.add_argument("--stream", action="store_true", help="print each snapshot (default)")
    return parser

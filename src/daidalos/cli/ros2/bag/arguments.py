"""Common arguments of the verbs of `ros2 bag`, with checks of their values and error messages."""

from __future__ import annotations

import os
import signal
import sys
import time
from argparse import ArgumentParser, ArgumentTypeError, Namespace
from collections.abc import Callable
from types import FrameType
from typing import TYPE_CHECKING, Any, Self

from ros2bag.api import check_not_negative_int, check_path_exists, check_positive_float

from daidalos.bags.storage import SUFFIXES
from daidalos.cli.ros2.errors import CliError

if TYPE_CHECKING:
    from rosbag2_py import StorageOptions

STORAGES = tuple(SUFFIXES)
POLL_S = 0.1
"""Polling period of requests to end [s]."""
_SAME_PRESS_S = 0.5


def add_bag_arguments(parser: ArgumentParser) -> None:
    """Declare the argument of the bag to read."""
    parser.add_argument("bag_path", type=check_path_exists, help="Bag to open: a folder, or one file of a bag")
    _add_storage(parser)


def _add_storage(parser: ArgumentParser) -> None:
    parser.add_argument(
        "-s",
        "--storage",
        default="",
        choices=STORAGES,
        help="Storage implementation of the bag. By default it is found out.",
    )


def add_bags_arguments(parser: ArgumentParser) -> None:
    """Declare the arguments of the bags to play: one positional, or several by an option."""
    parser.add_argument(
        "bag_path", type=check_path_exists, nargs="?", help="Bag to open: a folder, or one file of a bag"
    )
    _add_storage(parser)
    parser.add_argument(
        "-i",
        "--input",
        action="append",
        nargs="+",
        default=[],
        metavar=("uri", "storage_id"),
        help="Path, and perhaps the storage, of a bag; may be given more than once: the messages of all bags are put "
        f"in one order by time. Storages are: {', '.join(STORAGES)}",
    )


def bags_to_play(args: Namespace) -> list[StorageOptions]:
    """Return the bags of `add_bags_arguments`; CliError if they contradict each other."""
    from rosbag2_py import StorageOptions

    if args.input and (args.bag_path or args.storage):
        raise error("Only one of bag_path (with --storage) and --input may be given.")
    if args.bag_path:
        return [StorageOptions(args.bag_path, args.storage)]
    if not args.input:
        raise error("Expected a bag to play: bag_path or --input")
    return input_bags(args.input)


def input_bags(inputs: list[list[str]]) -> list[StorageOptions]:
    """Return the bags of several options `--input`; CliError if they are invalid."""
    from rosbag2_py import StorageOptions

    bags = []
    for words in inputs:
        if len(words) > 2:
            raise error(f"--input expects 1 or 2 arguments, {len(words)} provided")
        path, storage = (*words, "")[:2]
        if storage and storage not in STORAGES:
            raise error(f"Unknown storage ID '{storage}', options are: {', '.join(STORAGES)}")
        if not os.path.exists(path):
            raise error(f"Bag path '{path}' does not exist!")
        bags.append(StorageOptions(path, storage))
    return bags


def add_start_offset(parser: ArgumentParser) -> None:
    """Declare the argument of the start offset."""
    parser.add_argument(
        "--start-offset",
        type=check_positive_float,
        default=0.0,
        metavar="SECONDS",
        help="Start so far into the bag",
    )


def add_topic_arguments(parser: ArgumentParser) -> None:
    """Declare the arguments that select and remap topics and services."""
    parser.add_argument(
        "--topics", default=[], nargs="+", metavar="topic", help="Topics to replay; all where none is named"
    )
    parser.add_argument(
        "--services", default=[], nargs="+", metavar="service", help="Services to replay; all where none is named"
    )
    parser.add_argument(
        "--qos-profile-overrides-path",
        type=existing_file,
        metavar="FILE",
        help="Path to a YAML file that defines overrides of the QoS profile for specific topics",
    )
    parser.add_argument(
        "-m",
        "--remap",
        default=[],
        nargs="+",
        metavar="old:=new",
        help='Topics to be remapped, in the form "old_topic1:=new_topic1 old_topic2:=new_topic2"',
    )
    parser.add_argument(
        "--storage-config-file", type=existing_file, metavar="FILE", help="Settings of the storage, as YAML"
    )
    parser.add_argument(
        "--read-ahead-queue-size",
        type=positive_int,
        default=1000,
        metavar="N",
        help="Number of messages that are read ahead (default: %(default)s)",
    )


def remapping_arguments(rules: list[str]) -> list[str]:
    """Return remapping rules as arguments of a node; CliError for an invalid rule."""
    words = []
    for rule in rules:
        old, sign, new = rule.partition(":=")
        if not (old and sign and new):
            raise error(f"--remap: '{rule}' is not a remapping rule; expected such as /old:=/new")
        words += ["--remap", rule]
    return ["--ros-args", *words] if words else []


def existing_file(text: str) -> str:
    """Return the path of an existing file; argument type."""
    if not os.path.isfile(text):
        raise ArgumentTypeError(f"can't open '{text}': there is no such file")
    return text


def positive_int(text: str) -> int:
    """Return an integer above 0; argument type."""
    value = check_not_negative_int(text)
    if value == 0:
        raise ArgumentTypeError(f"{text} is not in the valid range (> 0)")
    return value


class ShutdownRequest:
    """Context that records requests to end the process by Ctrl-C, ``kill`` or ``kill -INT``.

    An exception out of a signal's handler could strike where a lock is held. A shell's script makes what it puts in
    the background ignore Ctrl-C, but ends it by ``kill -INT``: that is heard all the same. Who asks again, later than
    one press of the keys takes, means it: the process dies at once.

    Parameters
    ----------
    on_asked
        Called by the handler: it may do no more than set an attribute.
    """

    def __init__(self, on_asked: Callable[[], None] = lambda: None) -> None:
        self.asked = False
        self._on_asked = on_asked
        self._first_s = 0.0
        self._before: dict[int, Any] = {}

    def __enter__(self) -> Self:
        for number in (signal.SIGINT, signal.SIGTERM):
            self._before[number] = signal.signal(number, self._note)
        return self

    def __exit__(self, *error: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _note(self, number: int, frame: FrameType | None) -> None:
        if not self.asked:
            self.asked, self._first_s = True, time.monotonic()
            self._on_asked()
        elif time.monotonic() - self._first_s > _SAME_PRESS_S:
            signal.signal(number, signal.SIG_DFL)
            signal.raise_signal(number)


def error(text: str) -> CliError:
    """Return the error that ends the command with a text."""
    return CliError(f"[ERROR] [ros2bag]: {text}")


def warn(text: str) -> None:
    """Print a warning."""
    print(f"[WARN] [ros2bag]: {text}", file=sys.stderr, flush=True)

"""Command lines of `rosbag record` and `rosbag play` as those of `ros2 bag`."""

from __future__ import annotations

import re
from argparse import ArgumentParser, ArgumentTypeError, Namespace
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import NoReturn

VERBS = ("record", "play")
_MEGABYTE = 1024 * 1024
_UNITS_S = {"": 1.0, "s": 1.0, "m": 60.0, "h": 3600.0}
_CLOCK_HZ = 100.0


@dataclass(frozen=True)
class BagCommand:
    """Command line of `ros2 bag`.

    Attributes
    ----------
    arguments
        The verb and its arguments.
    notes
        What was asked for and is not done, a line each.
    duration_s
        After so many seconds the recording is to be ended.
    """

    arguments: list[str]
    notes: list[str] = field(default_factory=list)
    duration_s: float | None = None


def ros2_command(
    verb: str, words: Iterable[str], namespace: str = "/", remappings: Iterable[tuple[str, str]] = ()
) -> BagCommand:
    """Return the command for the words that followed `rosbag record` or `rosbag play`.

    Parameters
    ----------
    verb
        ``record`` or ``play``.
    words
        The options, topics, bags and remappings.
    namespace
        Where relative names of topics begin.
    remappings
        More names of topics, and what they become.

    Raises
    ------
    ValueError
        When the words are not valid.
    """
    words = list(words)
    pairs = [*remappings, *(_pair(word) for word in words if ":=" in word and not word.startswith("_"))]
    rules = {_absolute(old, namespace): _absolute(new, namespace) for old, new in pairs}
    rest = [word for word in words if ":=" not in word]
    if verb == "play":
        return _play(_PLAY.parse_intermixed_args(rest), rules)
    return _record(_RECORD.parse_intermixed_args(rest), namespace, rules)


def _pair(rule: str) -> tuple[str, str]:
    old, _, new = rule.partition(":=")
    return old, new


def _absolute(name: str, namespace: str) -> str:
    return name if name.startswith("/") else f"{namespace.rstrip('/')}/{name}"


def _record(old: Namespace, namespace: str, rules: Mapping[str, str]) -> BagCommand:
    new = ["record", *_output(old)]
    if old.all:
        new.append("--all-topics")
    elif old.regex:
        # Each topic had to match as a whole.
        new += ["--regex", "|".join(f"^({text})$" for text in old.topics)]
    elif old.topics:
        names = [_absolute(topic, namespace) for topic in old.topics]
        new += ["--topics", *(rules.get(name, name) for name in names)]
    if old.exclude:
        new += ["--exclude-regex", f"^({old.exclude})$"]
    if old.quiet:
        new += ["--log-level", "warn"]
    if old.buffsize:
        new += ["--max-cache-size", str(old.buffsize * _MEGABYTE)]
    if old.bz2 or old.lz4:
        new += ["--compression-mode", "file", "--compression-format", "zstd"]
    notes = _unused(old, _UNUSED_BY_RECORD)
    if old.split:
        new += ["--max-bag-size", str(old.size * _MEGABYTE)] if old.size else []
        new += ["--max-bag-duration", f"{old.duration:g}"] if old.duration else []
    elif old.size:
        notes.append("--size without --split has no counterpart: the recording does not end by its size")
    return BagCommand(new, notes, None if old.split else old.duration)


def _output(old: Namespace) -> list[str]:
    """Return where to the bag is written: it is a folder today."""
    if old.output_name:
        return ["--output", _without_suffix(old.output_name)]
    if old.output_prefix:
        prefix = _without_suffix(old.output_prefix)
        return ["--output", datetime.now().strftime(f"{prefix}_%Y_%m_%d-%H_%M_%S")]
    return []


def _play(old: Namespace, rules: Mapping[str, str]) -> BagCommand:
    bags = [_bag(name) for name in [*old.bagfiles, *old.bags]]
    if not bags:
        raise ValueError("expected a bag to play, found none")
    new = ["play", *bags] if len(bags) == 1 else ["play", *(word for bag in bags for word in ("--input", bag))]
    if old.clock:
        new += ["--clock", f"{old.hz:g}"]
    for option, value in (
        ("--rate", old.rate),
        ("--delay", old.delay),
        ("--start-offset", old.start),
        ("--playback-duration", old.duration),
        ("--read-ahead-queue-size", old.queue),
    ):
        if value:
            new += [option, f"{value:g}"]
    new += ["--loop"] if old.loop else []
    new += ["--start-paused"] if old.pause else []
    new += ["--log-level", "warn"] if old.quiet else []
    new += ["--topics", *old.topics] if old.topics else []
    new += ["--remap", *(f"{before}:={after}" for before, after in rules.items())] if rules else []
    return BagCommand(new, _unused(old, _UNUSED_BY_PLAY))


def _bag(name: str) -> str:
    """Return the bag that was meant: what was recorded by today's command is a folder without the old ending."""
    return name if Path(name).exists() else _without_suffix(name)


def _without_suffix(name: str) -> str:
    return name.removesuffix(".bag") or name


def _unused(old: Namespace, options: Mapping[str, str]) -> list[str]:
    return [
        f"{option} has no counterpart: {consequence}"
        for option, consequence in options.items()
        if getattr(old, option.strip("-").replace("-", "_"))
    ]


class _Parser(ArgumentParser):
    """Parser that raises ValueError where the command would exit."""

    def error(self, message: str) -> NoReturn:
        raise ValueError(f"{self.prog}: {message}")


def _duration(text: str) -> float:
    match = re.fullmatch(r"(\d+(?:\.\d*)?)([smh]?)", text)
    if match is None:
        raise ArgumentTypeError(f"'{text}' is not a duration; expected such as 30s, 5m or 2h")
    return float(match[1]) * _UNITS_S[match[2]]


_UNUSED_BY_RECORD = {
    "--chunksize": "chunks are a setting of the storage",
    "--limit": "the number of messages is not limited",
    "--max-splits": "no file is deleted",
    "--node": "name the topics instead",
    "--publish": "the file's name is not published",
    "--repeat-latched": "the first file has the latched messages",
}
_UNUSED_BY_PLAY = {
    "--immediate": "the messages keep their times",
    "--keep-alive": "it ends with the bag",
    "--pause-topics": "it does not pause by itself",
    "--prefix": "the topics keep their names",
    "--rate-control-topic": "the rate is the one given",
    "--skip-empty": "empty parts are not skipped",
    "--wait-for-subscribers": "it begins at once",
}


def _record_parser() -> _Parser:
    parser = _Parser(prog="rosbag record", add_help=False, allow_abbrev=False)
    add = parser.add_argument
    add("topics", nargs="*")
    for names in (
        ("-a", "--all"),
        ("-e", "--regex"),
        ("-p", "--publish"),
        ("-q", "--quiet"),
        ("--split",),
        ("-j", "--bz2"),
        ("--lz4",),
        ("--repeat-latched",),
        ("--tcpnodelay",),
        ("--udp",),
    ):
        add(*names, action="store_true")
    for names in (
        ("-x", "--exclude"),
        ("-o", "--output-prefix"),
        ("-O", "--output-name"),
        ("--max-splits",),
        ("--chunksize",),
        ("-l", "--limit"),
        ("--node",),
    ):
        add(*names)
    add("--size", type=int)
    add("-b", "--buffsize", type=int)
    add("-d", "--duration", type=_duration)
    return parser


def _play_parser() -> _Parser:
    parser = _Parser(prog="rosbag play", add_help=False, allow_abbrev=False)
    add = parser.add_argument
    add("bagfiles", nargs="*")
    for names in (
        ("-q", "--quiet"),
        ("-i", "--immediate"),
        ("--pause",),
        ("--clock",),
        ("-l", "--loop"),
        ("-k", "--keep-alive"),
        ("--try-future-version",),
        ("--wait-for-subscribers",),
    ):
        add(*names, action="store_true")
    for names in (("-p", "--prefix"), ("--skip-empty",), ("--rate-control-topic",), ("--rate-control-max-delay",)):
        add(*names)
    add("--hz", type=float, default=_CLOCK_HZ)
    add("--queue", type=int)
    for names in (("-r", "--rate"), ("-d", "--delay"), ("-s", "--start"), ("-u", "--duration")):
        add(*names, type=float)
    for name in ("--topics", "--pause-topics", "--bags"):
        add(name, nargs="+", default=[])
    return parser


_RECORD, _PLAY = _record_parser(), _play_parser()

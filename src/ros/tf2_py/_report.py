"""Reports of a buffer: warnings of bad input, and its tree as text."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import isnan
from typing import Any, NamedTuple

from ._history import display_time
from ._rigid import Rigid

_LOGGER_NAME = "tf2_buffer"
_MIN_DURATION_S = 1e-4


def problem_with(parent: str, child: str, motion: Rigid, authority: str, tolerance: float) -> str:
    """Return why a transform is not valid, "" when it is."""
    parent, child = parent.removeprefix("/"), child.removeprefix("/")
    rotation = "({:f} {:f} {:f} {:f})".format(*motion[3:])
    if not child:
        return f'TF_NO_CHILD_FRAME_ID: Ignoring transform from authority "{authority}" because child_frame_id not set '
    if not parent:
        return (
            f'TF_NO_FRAME_ID: Ignoring transform with child_frame_id "{child}"  from authority "{authority}" '
            "because frame_id not set"
        )
    if parent == child:
        return (
            f'TF_SELF_TRANSFORM: Ignoring transform from authority "{authority}" with frame_id and  child_frame_id '
            f'"{child}" because they are the same'
        )
    if any(map(isnan, motion)):
        translation = "({:f} {:f} {:f})".format(*motion[:3])
        return (
            f'TF_NAN_INPUT: Ignoring transform for child_frame_id "{child}" from authority "{authority}" because of '
            f"a nan value in the transform {translation} {rotation}"
        )
    if not abs(sum(value * value for value in motion[3:]) - 1.0) < tolerance:
        return (
            f'TF_DENORMALIZED_QUATERNION: Ignoring transform for child_frame_id "{child}" from authority '
            f'"{authority}" because of an invalid quaternion in the transform {rotation}'
        )
    return ""


def error(text: str) -> None:
    """Log that a transform was ignored."""
    from rclpy.logging import get_logger

    get_logger(_LOGGER_NAME).error(text)


def old_data(child: str, stamp: int, authority: str) -> None:
    """Log that a transform came too late."""
    from rclpy.logging import get_logger

    get_logger(_LOGGER_NAME).warning(
        f"TF_OLD_DATA ignoring data from the past for frame {child} at time {display_time(stamp)} according to "
        f"authority {authority}\nPossible reasons are listed at http://wiki.ros.org/tf/Errors%20explained"
    )


class _Row(NamedTuple):
    """Row of a frame; times in nanoseconds."""

    frame: str
    parent: str
    authority: str
    rate: float
    oldest: int
    latest: int


def _rows(frames: Mapping[str, Any], authorities: Mapping[str, str]) -> Iterator[_Row]:
    for frame, history in frames.items():
        latest, parent = (0, "") if history is None else history.latest()
        if not parent:
            continue
        stamps = history.stamps
        oldest = stamps[0] if stamps else 0
        rate = max(len(stamps), 1) / max((latest - oldest) / 1e9, _MIN_DURATION_S)
        yield _Row(frame, parent, authorities.get(frame, "no recorded authority"), rate, oldest, latest)


def as_sentences(frames: Mapping[str, Any]) -> str:
    """Return one sentence for every frame that has a parent."""
    return "".join(
        f"Frame {frame} exists with parent {history.latest()[1] or 'NO_PARENT'}.\n"
        for frame, history in frames.items()
        if history is not None
    )


def as_yaml(frames: Mapping[str, Any], authorities: Mapping[str, str]) -> str:
    """Return the tree as YAML."""
    if not frames:
        return "[]"
    return "".join(
        f"{row.frame}: \n"
        f"  parent: '{row.parent}'\n"
        f"  broadcaster: '{row.authority}'\n"
        f"  rate: {row.rate:.3f}\n"
        f"  most_recent_transform: {display_time(row.latest)}\n"
        f"  oldest_transform: {display_time(row.oldest)}\n"
        f"  buffer_length: {(row.latest - row.oldest) / 1e9:.3f}\n"
        for row in _rows(frames, authorities)
    )


def as_dot(frames: Mapping[str, Any], authorities: Mapping[str, str], now: int) -> str:
    """Return the tree in Graphviz's language; `now` in nanoseconds is 0 when it is not known."""
    lines = ["digraph G {"]
    if not frames:
        lines.append('"no tf data received"')
    rows = list(_rows(frames, authorities))
    for row in rows:
        age = f"( {(now - row.latest) / 1e9:.3f} sec old)" if now else ""
        lines.append(
            f'"{row.parent}" -> "{row.frame}"[label="Broadcaster: {row.authority}\\n'
            f"Average rate: {row.rate:.3f} Hz\\n"
            f"Most recent transform: {display_time(row.latest)} {age}\\n"
            f'Buffer length: {(row.latest - row.oldest) / 1e9:.3f} sec\\n"];'
        )
    children = {row.frame for row in rows}
    roots = dict.fromkeys(row.parent for row in rows if row.parent not in children)
    if roots:
        lines.append(
            f'edge [style=invis];\nsubgraph cluster_legend {{ style=bold; color=black; label ="view_frames '
            f'Result";\n"Recorded at time: {now / 1e9:.3f}"[ shape=plaintext ] ;\n}}'
        )
        lines += [f'"Recorded at time: {now / 1e9:.3f}"->"{root}";' for root in roots]
    return "\n".join([*lines, "}"])

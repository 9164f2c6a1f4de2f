"""Assertions about what processes print."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ..tools.output import expect_output
from ..util.proc_lookup import process_details, resolveProcesses


def assertInStream(
    proc_output: Any,
    expected_output: Any,
    process: Any,
    cmd_args: Any = None,
    *,
    output_filter: Callable[[str], str] | None = None,
    strict_proc_matching: bool = True,
    strip_ansi_escape_sequences: bool = True,
    stream: str = "stderr",
) -> None:
    """Assert that a process printed something to one of its streams.

    Parameters
    ----------
    proc_output
        Knows what the processes printed.
    expected_output
        A text, a regular expression, several of these that follow one another, or a function that takes the
        whole text and tells.
    process, cmd_args, strict_proc_matching
        Which process, as for `launch_testing.util.resolveProcesses`; any one of those found will do.
    output_filter
        Applied to the text first.
    strip_ansi_escape_sequences
        Whether colours are taken out first.
    stream
        'stdout' or 'stderr'.

    Raises
    ------
    AssertionError
        If none printed it.
    """
    found = resolveProcesses(proc_output, process=process, cmd_args=cmd_args, strict_proc_matching=strict_proc_matching)
    matches = (
        expected_output if callable(expected_output) else _expectation(expected_output, strip_ansi_escape_sequences)
    )
    for action in found:
        text = "".join(
            piece.text.decode(errors="replace")
            for piece in proc_output[action]
            if (piece.from_stdout if stream == "stdout" else piece.from_stderr)
        )
        if matches(text if output_filter is None else output_filter(text)):
            return
    names = ", ".join(process_details(action)["name"] for action in found)
    raise AssertionError(f"Did not find '{expected_output}' in the {stream} of any of the matching processes: {names}")


def assertInStdout(
    proc_output: Any,
    expected_output: Any,
    process: Any,
    cmd_args: Any = None,
    *,
    output_filter: Callable[[str], str] | None = None,
    strict_proc_matching: bool = True,
    strip_ansi_escape_sequences: bool = True,
) -> None:
    """Assert that a process printed something to its standard output; see `assertInStream`."""
    assertInStream(
        proc_output,
        expected_output,
        process,
        cmd_args,
        output_filter=output_filter,
        strict_proc_matching=strict_proc_matching,
        strip_ansi_escape_sequences=strip_ansi_escape_sequences,
        stream="stdout",
    )


def assertInStderr(
    proc_output: Any,
    expected_output: Any,
    process: Any,
    cmd_args: Any = None,
    *,
    output_filter: Callable[[str], str] | None = None,
    strict_proc_matching: bool = True,
    strip_ansi_escape_sequences: bool = True,
) -> None:
    """Assert that a process printed something to its standard error; see `assertInStream`."""
    assertInStream(
        proc_output,
        expected_output,
        process,
        cmd_args,
        output_filter=output_filter,
        strict_proc_matching=strict_proc_matching,
        strip_ansi_escape_sequences=strip_ansi_escape_sequences,
        stream="stderr",
    )


def assertDefaultStream() -> str:
    """Return the stream that is meant where none is named: that of ROS's log messages."""
    return "stderr"


def _expectation(expected: Any, strip_ansi_escape_sequences: bool) -> Callable[[str], bool]:
    return lambda text: expect_output(
        expected_text=expected, text=text, strip_ansi_escape_sequences=strip_ansi_escape_sequences
    )

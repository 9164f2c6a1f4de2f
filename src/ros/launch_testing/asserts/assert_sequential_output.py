"""Assertions about the order in which a process prints."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from ..util.proc_lookup import resolveProcesses


class SequentialTextChecker:
    """Checker that finds texts one after another: each search begins where the last one ended.

    Parameters
    ----------
    output
        The pieces of output.
    """

    def __init__(self, output: list[Any]) -> None:
        self._text = "".join(piece if isinstance(piece, str) else piece.text.decode() for piece in output)
        self._position = 0

    def assertInText(self, msg: str) -> None:
        """Assert that a text comes after those found before.

        Raises
        ------
        AssertionError
            If it does not.
        """
        found = self._text.find(msg, self._position)
        if found < 0:
            before = " (it came earlier)" if msg in self._text else ""
            raise AssertionError(f"'{msg}' not found in the output after:{before}\n{self.get_nearby_lines()}")
        self._position = found + len(msg)

    def assertInStdout(self, msg: str) -> None:
        """Assert that a text comes after those found before; see `assertInText`."""
        self.assertInText(msg)

    def get_nearby_lines(self) -> str:
        """Return the line in which the next search begins, with two lines before and after it."""
        current = self._text[: self._position + 1].count("\n")
        return "\n".join(self._text.splitlines()[max(0, current - 2) : current + 3])


@contextmanager
def assertSequentialStdout(proc_output: Any, process: Any, cmd_args: Any = None) -> Iterator[SequentialTextChecker]:
    """Yield a checker of the order in which one process printed to its standard output.

    Parameters
    ----------
    proc_output
        Knows what the processes printed.
    process, cmd_args
        Which process, as for `launch_testing.util.resolveProcesses`.
    """
    found = resolveProcesses(proc_output, process=process, cmd_args=cmd_args, strict_proc_matching=True)
    if len(found) != 1:
        raise LookupError(f"expected exactly one process for '{process}', found {len(found)}")
    yield SequentialTextChecker([piece for piece in proc_output[found[0]] if piece.from_stdout])

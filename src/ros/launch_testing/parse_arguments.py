"""Launch arguments from a command line."""

from __future__ import annotations


def parse_launch_arguments(launch_arguments: list[str]) -> list[tuple[str, str]]:
    """Return names and values of arguments like `name:=value`; the last of several for one name counts.

    Raises
    ------
    RuntimeError
        If one is not of this form.
    """
    parsed: dict[str, str] = {}
    for argument in launch_arguments:
        name, separator, value = argument.partition(":=")
        if not (separator and name):
            raise RuntimeError(f"malformed launch argument '{argument}', expected format '<name>:=<value>'")
        parsed[name] = value
    return list(parsed.items())

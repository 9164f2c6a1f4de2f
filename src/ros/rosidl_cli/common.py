"""Text that commands share."""

from __future__ import annotations

from daidalos.common.extensions import first_line


def get_first_line_doc(any_type: object) -> str:
    """Return the first line of a docstring without its full stop; empty without a docstring."""
    return first_line(any_type)

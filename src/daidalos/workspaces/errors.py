"""Error of users' packages."""

from __future__ import annotations


class WorkspaceError(ValueError):
    """Invalid file of a package; the message names file and line."""

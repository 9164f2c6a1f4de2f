"""What users' packages can have wrong with them."""

from __future__ import annotations


class WorkspaceError(ValueError):
    """A file of a package says something that it may not; the message names the file and the line."""

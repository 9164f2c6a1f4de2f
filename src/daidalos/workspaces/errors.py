"""Error of users' packages."""

from __future__ import annotations

from daidalos.common.errors import UserError


class WorkspaceError(UserError, ValueError):
    """Invalid file of a package; the message names file and line."""

"""The type of a path to a file."""

from __future__ import annotations

import os

FilePath = str | bytes | os.PathLike[str]

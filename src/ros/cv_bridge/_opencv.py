"""OpenCV where it is installed; what it alone can do is refused politely where it is not."""

from __future__ import annotations

import importlib
from functools import lru_cache
from typing import Any

COMMAND = "pip install 'daidalos[vision]'"


@lru_cache(maxsize=1)
def opencv() -> Any:
    """Return OpenCV, imported when first asked for; None when it is not installed."""
    try:
        return importlib.import_module("cv2")
    except ImportError:
        return None

"""`xacro`: expands a robot description with macros; the real command of the xacro package."""

from __future__ import annotations

import sys


def main() -> int:
    """Run the command."""
    from xacro import main as expand

    expand()
    return 0


if __name__ == "__main__":
    sys.exit(main())

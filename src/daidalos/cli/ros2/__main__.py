"""Entry point of `python -m daidalos.cli.ros2`, for environments without `ros2` on the path."""

import sys

from daidalos.cli.ros2 import main

sys.exit(main())

"""`python -m daidalos.cli.ros2`: the command `ros2` where it is not on the path."""

import sys

from daidalos.cli.ros2 import main

sys.exit(main())

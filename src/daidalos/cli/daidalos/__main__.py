"""Run `daidalos` as a module."""

import sys

from daidalos.cli.daidalos import main

sys.exit(main())

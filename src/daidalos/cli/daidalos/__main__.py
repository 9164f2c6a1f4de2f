"""Entry point of `python -m daidalos.cli.daidalos`."""

import sys

from daidalos.cli.daidalos import main

sys.exit(main())

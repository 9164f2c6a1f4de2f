"""`rqt`: see `rqt_gui`."""

import sys

from daidalos.nodes.rqt_gui.rqt_gui import main

if __name__ == "__main__":
    sys.exit(main())

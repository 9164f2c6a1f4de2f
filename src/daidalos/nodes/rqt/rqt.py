"""`rqt`: see `rqt_gui`."""

from daidalos.nodes.rqt_gui.rqt_gui import main as main

"""Markers in space that people move, click and open menus of."""

from .interactive_marker_server import InteractiveMarkerServer as InteractiveMarkerServer
from .menu_handler import MenuHandler as MenuHandler

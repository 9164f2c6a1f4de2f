"""Studio server with the graph of a node."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import webbrowser
from collections.abc import Sequence
from pathlib import Path
from urllib.parse import urlencode

from rclpy.node import Node

from daidalos.distribution import DISTRIBUTION
from daidalos.nodes.asset_folders import is_asset_readable
from daidalos.nodes.foxglove_bridge._graph_source import RosGraphSource
from daidalos.nodes.packages import package_share
from daidalos.studio.arrangement import Arrangement
from daidalos.studio.assets import AssetResolver
from daidalos.studio.server import DEFAULT_PORT, LOOPBACK, StudioServer


class Studio:
    """The studio's server, with the graph of a node; it serves from its construction until `close`.

    Parameters
    ----------
    node
        Listens, publishes and calls for the page; it must be spun.
    port
        The port to listen on, or the next free one above.
    hosts
        Addresses to listen on.
    arrangement
        The layout with which the page opens; None: the page's default.

    Raises
    ------
    PortError
        When no port can be opened.
    """

    def __init__(
        self,
        node: Node,
        port: int = DEFAULT_PORT,
        hosts: Sequence[str] = LOOPBACK,
        arrangement: Arrangement | None = None,
    ) -> None:
        self._source = RosGraphSource(node)
        self._server = StudioServer(
            self._source,
            port=port,
            hosts=hosts,
            assets=AssetResolver(_share_directory, is_asset_readable, node.get_logger().warning),
            arrangement=arrangement,
            metadata={"ROS_DISTRO": os.environ.get("ROS_DISTRO", DISTRIBUTION)},
        )
        self._server.start()

    def url(self, panel: str = "", front: str = "", **details: str) -> str:
        """Return the page's address for a browser on this machine.

        Parameters
        ----------
        panel : str
            The panel to open as a window of its own.
        front : str
            The panel of the whole page to bring to the front.
        **details
            Further query parameters, for the panel.
        """
        asked = {"panel": panel, **details} if panel else {"front": front} if front else {}
        query = urlencode(asked, safe="/")
        return f"{self._server.url}?{query}" if query else self._server.url

    def close(self) -> None:
        """Close the page's connections and the port."""
        self._server.stop()
        self._source.close()


def open_in_browser(url: str) -> bool:
    """Open an address in the user's browser where there is a screen; return whether there is one."""
    if "WSL_DISTRO_NAME" in os.environ and "BROWSER" not in os.environ:
        opener = shutil.which("wslview") or shutil.which("explorer.exe")  # the browser is that of Windows
        if opener is not None:
            subprocess.Popen([opener, url], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            return True
    has_screen = sys.platform in ("win32", "darwin") or any(
        os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")
    )
    return has_screen and webbrowser.open(url)


def _share_directory(name: str) -> Path | None:
    found = package_share(name)
    return None if found is None else Path(found)

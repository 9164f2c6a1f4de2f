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
from daidalos.nodes.server_access import Access, chosen_token, warn_of_exposure
from daidalos.studio.arrangement import Arrangement
from daidalos.studio.assets import AssetResolver
from daidalos.studio.guarded_server import LOOPBACK
from daidalos.studio.server import DEFAULT_PORT, StudioServer


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
    access
        Who may connect besides, and by which certificate connections are encrypted.

    Raises
    ------
    PortError
        When no port can be opened.
    UserError
        When the certificate cannot be used, or the token is too short.
    """

    def __init__(
        self,
        node: Node,
        port: int = DEFAULT_PORT,
        hosts: Sequence[str] = LOOPBACK,
        arrangement: Arrangement | None = None,
        access: Access | None = None,
    ) -> None:
        access = access or Access()
        self._source = RosGraphSource(node)
        self._server = StudioServer(
            self._source,
            port=port,
            hosts=hosts,
            assets=AssetResolver(_share_directory, is_asset_readable, node.get_logger().warning),
            arrangement=arrangement,
            allowed_hosts=access.hosts,
            allowed_origins=access.origins,
            token=chosen_token(),
            tls=access.tls_context(),
            metadata={"ROS_DISTRO": os.environ.get("ROS_DISTRO", DISTRIBUTION)},
        )
        self._server.start()

    @property
    def port(self) -> int:
        """The port that was opened."""
        return self._server.port

    @property
    def asks_for_token(self) -> bool:
        """Whether the page's address holds a token."""
        return self._server.asks_for_token

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
        url = self._server.url
        return f"{url}{'&' if '?' in url else '?'}{query}" if query else url

    def warn_of_exposure(self, node: Node) -> None:
        """Print the address for other machines, and warn of what they can do, where they can reach the page."""
        warn_of_exposure(node, self._server, "studio")

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

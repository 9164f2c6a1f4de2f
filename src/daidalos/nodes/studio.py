"""Studio server with the graph of a node."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import webbrowser
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

from rclpy.node import Node

from daidalos.description.resolve import default_model_path
from daidalos.distribution import DISTRIBUTION
from daidalos.nodes.foxglove_bridge._graph_source import RosGraphSource
from daidalos.nodes.packages import package_share
from daidalos.nodes.qos import LATCHED
from daidalos.studio.arrangement import Arrangement
from daidalos.studio.assets import AssetResolver
from daidalos.studio.server import DEFAULT_PORT, LOOPBACK, StudioServer
from daidalos.transport.graph import EndpointInfo, EndpointKind, NodeInfo


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
        self._node = node
        self._graph = node.handle.graph
        self._assets = AssetResolver(_share_directory, default_model_path())
        self._source = RosGraphSource(node, self._read_shapes)
        self._server = StudioServer(
            self._source,
            port=port,
            hosts=hosts,
            assets=self._assets,
            arrangement=arrangement,
            metadata={"ROS_DISTRO": os.environ.get("ROS_DISTRO", DISTRIBUTION)},
        )
        self._server.start()
        self._seen: set[str] = set()
        self._description_found = node.create_guard_condition(self._read_descriptions)
        self._stop_watching = self._graph.listen(self._on_graph_change)
        self._description_found.trigger()

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
        self._stop_watching()
        self._server.stop()
        self._source.close()

    def _on_graph_change(self, added: bool, what: NodeInfo | EndpointInfo) -> None:
        if added and isinstance(what, EndpointInfo) and what.name.endswith("/robot_description"):
            self._description_found.trigger()

    def _read_descriptions(self) -> None:
        """Allow the page the meshes of every robot that is described in the graph."""
        from std_msgs.msg import String

        published = {endpoint.name for endpoint in self._graph.endpoints(EndpointKind.PUBLISHER)}
        for topic in {name for name in published if name.endswith("/robot_description")} - self._seen:
            self._seen.add(topic)
            self._node.create_subscription(String, topic, lambda text: self._assets.allow_meshes_of(text.data), LATCHED)

    def _read_shapes(self, response: Any) -> None:
        """Allow the page the meshes and textures of the shapes that a simulator returns."""
        from daidalos_msgs.srv import GetShapes

        if isinstance(response, GetShapes.Response):
            for shape in response.shapes:
                self._assets.allow(shape.mesh_resource)
                self._assets.allow(shape.texture_resource)


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

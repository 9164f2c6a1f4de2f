"""`foxglove_bridge`: the studio's page, with the graph for it and for other clients of its protocol."""

from __future__ import annotations

from typing import Any

from rclpy.node import Node

from daidalos.nodes.runner import UserError
from daidalos.nodes.studio import Studio, open_in_browser
from daidalos.studio.ports import PortError
from daidalos.studio.server import DEFAULT_PORT, LOOPBACK


class FoxgloveBridge(Node):
    """Node that serves the studio on ``http://localhost:<port>/``.

    Parameters of the node: ``port`` (the next free one is taken where it is used), ``address`` (loopback unless
    told otherwise), ``open_browser``, ``front`` (the panel that the page opens with).

    Raises
    ------
    UserError
        When no port can be opened.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("foxglove_bridge", **kwargs)
        port = self.declare_parameter("port", DEFAULT_PORT).value
        address = self.declare_parameter("address", "").value
        open_browser = self.declare_parameter("open_browser", False).value
        front = self.declare_parameter("front", "").value
        try:
            self._studio = Studio(self, port, (address,) if address else LOOPBACK)
        except PortError as error:
            super().destroy_node()
            raise UserError(str(error)) from None
        url = self._studio.url(front=front)
        self.get_logger().info(f"studio: {url}")
        if open_browser:
            open_in_browser(url)

    def destroy_node(self) -> None:
        """Close the page's connections and leave the graph."""
        self._studio.close()
        super().destroy_node()

"""`foxglove_bridge`: the studio's page, with the graph for it and for other clients of its protocol."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from rclpy.node import Node

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import UserError
from daidalos.nodes.studio import Studio, open_in_browser
from daidalos.studio.ports import PortError
from daidalos.studio.server import DEFAULT_PORT, LOOPBACK


@dataclass(frozen=True)
class FoxgloveBridgeParameters(Parameters):
    """Parameters of ``foxglove_bridge``."""

    port: int = parameter(DEFAULT_PORT, "TCP port; the next free one where it is used.", minimum=0, maximum=65535)
    address: str = parameter("", "Address to listen on; loopback where empty.")
    open_browser: bool = parameter(False, "Whether to open the page in the browser.")
    front: str = parameter("", "Panel that the page opens with.")


class FoxgloveBridge(Node):
    """Node that serves the studio on ``http://localhost:<port>/``.

    Raises
    ------
    UserError
        When no port can be opened.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("foxglove_bridge", **kwargs)
        settings = declare(self, FoxgloveBridgeParameters)
        try:
            self._studio = Studio(self, settings.port, (settings.address,) if settings.address else LOOPBACK)
        except PortError as error:
            super().destroy_node()
            raise UserError(str(error)) from None
        url = self._studio.url(front=settings.front)
        self.get_logger().info(f"studio: {url}")
        if settings.open_browser:
            open_in_browser(url)

    def destroy_node(self) -> None:
        """Close the page's connections and leave the graph."""
        self._studio.close()
        super().destroy_node()

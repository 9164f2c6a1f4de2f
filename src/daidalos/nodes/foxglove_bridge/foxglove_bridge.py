"""`foxglove_bridge`: the studio's page, with the graph for it and for other clients of its protocol."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from typing import Any

from rclpy.node import Node

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import UserError
from daidalos.nodes.server_access import Access, listening_hosts
from daidalos.nodes.studio import Studio, open_in_browser
from daidalos.studio.ports import PortError
from daidalos.studio.server import DEFAULT_PORT


@dataclass(frozen=True)
class FoxgloveBridgeParameters(Parameters):
    """Parameters of ``foxglove_bridge``."""

    port: int = parameter(DEFAULT_PORT, "TCP port; the next free one where it is used.", minimum=0, maximum=65535)
    address: str = parameter("", "Address to listen on; loopback where empty.")
    tls: bool = parameter(
        False, "Whether connections are encrypted, with ``certfile`` and ``keyfile``.", read_only=True
    )
    certfile: str = parameter("", "Certificate in PEM format.", read_only=True)
    keyfile: str = parameter("", "Private key in PEM format; where empty, it is in ``certfile``.", read_only=True)
    allowed_origins: tuple[str, ...] = parameter(
        ("",), "Pages of other servers that may connect, such as ``https://app.foxglove.dev``.", read_only=True
    )
    allowed_hosts: tuple[str, ...] = parameter(
        ("",), "Names under which a server on loopback is reached, such as that of a proxy.", read_only=True
    )
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
            access = Access.of(
                settings.allowed_hosts,
                settings.allowed_origins,
                tls=settings.tls,
                certfile=settings.certfile,
                keyfile=settings.keyfile,
            )
            self._studio = Studio(self, settings.port, listening_hosts(settings.address), access=access)
        except (PortError, UserError) as error:
            super().destroy_node()
            raise UserError(str(error)) from None
        url = self._studio.url(front=settings.front)
        if self._studio.asks_for_token:  # which is not for the log, that everyone in the graph reads
            print(f"studio: {url}", file=sys.stderr, flush=True)
            self.get_logger().info(f"studio: the port is {self._studio.port}; the address is in the terminal")
        else:
            self.get_logger().info(f"studio: {url}")
        self._studio.warn_of_exposure(self)
        if settings.open_browser:
            open_in_browser(url)

    def destroy_node(self) -> None:
        """Close the page's connections and leave the graph."""
        self._studio.close()
        super().destroy_node()

"""`foxglove_bridge`: the studio's page, and the graph for it and for other clients of its protocol."""

from __future__ import annotations

import sys
import webbrowser
from pathlib import Path
from typing import Any

from rclpy.node import Node

from daidalos.nodes.foxglove_bridge._graph_source import RosGraphSource
from daidalos.nodes.packages import package_share
from daidalos.nodes.runner import UserError, run
from daidalos.studio.assets import AssetResolver
from daidalos.studio.ports import PortError
from daidalos.studio.server import DEFAULT_PORT, LOOPBACK, StudioServer


class FoxgloveBridge(Node):
    """Serves the studio on ``http://localhost:<port>/``.

    Parameters of the node: ``port`` (the next free one is taken where it is used), ``address`` (loopback unless
    told otherwise), ``open_browser``.

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
        self._source = RosGraphSource(self)
        assets = AssetResolver(_share_directory)
        self._server = StudioServer(self._source, port=port, hosts=(address,) if address else LOOPBACK, assets=assets)
        try:
            self._server.start()
        except PortError as error:
            super().destroy_node()
            raise UserError(str(error)) from None
        self.get_logger().info(f"studio: {self._server.url}")
        if open_browser:
            webbrowser.open(self._server.url)

    def destroy_node(self) -> None:
        """Close the page's connections and leave the graph."""
        self._server.stop()
        self._source.close()
        super().destroy_node()


def _share_directory(name: str) -> Path | None:
    found = package_share(name)
    return None if found is None else Path(found)


def main() -> int:
    """Run the node."""
    return run(FoxgloveBridge)


if __name__ == "__main__":
    sys.exit(main())

"""`foxglove_bridge`: the studio's page, and the graph for it and for other clients of its protocol."""

from __future__ import annotations

import os
import sys
import webbrowser
from pathlib import Path
from typing import Any

from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile

from daidalos.nodes.foxglove_bridge._graph_source import RosGraphSource
from daidalos.nodes.packages import package_share
from daidalos.nodes.runner import UserError, run
from daidalos.studio.assets import AssetResolver
from daidalos.studio.ports import PortError
from daidalos.studio.server import DEFAULT_PORT, LOOPBACK, StudioServer
from daidalos.transport.graph import EndpointInfo, EndpointKind, NodeInfo

_DISTRIBUTION = "jazzy"


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
        self._assets = AssetResolver(_share_directory)
        self._server = StudioServer(
            self._source,
            port=port,
            hosts=(address,) if address else LOOPBACK,
            assets=self._assets,
            metadata={"ROS_DISTRO": os.environ.get("ROS_DISTRO", _DISTRIBUTION)},
        )
        try:
            self._server.start()
        except PortError as error:
            super().destroy_node()
            raise UserError(str(error)) from None
        self.get_logger().info(f"studio: {self._server.url}")
        self._read_descriptions()
        if open_browser:
            webbrowser.open(self._server.url)

    def _read_descriptions(self) -> None:
        """Let the page have the meshes of every robot that is described in the graph, now or later."""
        from std_msgs.msg import String

        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        read: set[str] = set()

        def listen_to(topic: str) -> None:
            self.create_subscription(String, topic, lambda text: self._assets.allow_meshes_of(text.data), latched)

        def note(added: bool, what: NodeInfo | EndpointInfo) -> None:
            topic = what.name
            if not added or not isinstance(what, EndpointInfo) or not topic.endswith("/robot_description"):
                return
            if what.kind is EndpointKind.PUBLISHER and topic not in read and self.executor is not None:
                read.add(topic)
                self.executor.create_task(listen_to, topic)

        read.add("/robot_description")
        listen_to("/robot_description")
        self._stop_noting = self.handle.graph.listen(note)

    def destroy_node(self) -> None:
        """Close the page's connections and leave the graph."""
        self._stop_noting()
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

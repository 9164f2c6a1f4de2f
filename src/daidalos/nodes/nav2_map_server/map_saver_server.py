"""`map_saver_server`: saves maps on request."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.nav2_map_server._saving import MapSaverParameters, SaveRequest, save
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import run


class MapSaver(ManagedNode):
    """Server of ``~/save_map``; parameters are Nav2's."""

    def __init__(self, node_name: str = "map_saver", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._settings = declare(self, MapSaverParameters, reconfigure=self._reconfigure)

    def _reconfigure(self, parameters: MapSaverParameters) -> None:
        self._settings = parameters

    def configure(self) -> None:
        """Create the service."""
        from nav2_msgs.srv import SaveMap

        self.create_service(SaveMap, "~/save_map", self._on_save)

    async def _on_save(self, request: Any, response: Any) -> Any:
        if not self.is_active:
            self.get_logger().error("Received save_map request but not in ACTIVE state, ignoring!")
            return response
        save_request = SaveRequest(
            request.map_topic or "map",
            request.map_url,
            request.map_mode,
            request.image_format,
            request.occupied_thresh,
            request.free_thresh,
        )
        response.result = await save(self, self._settings, save_request)
        return response


def main() -> int:
    """Run the node."""
    return run(MapSaver)

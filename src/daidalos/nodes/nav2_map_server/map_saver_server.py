"""`map_saver_server`: saves maps when its service is called."""

from __future__ import annotations

import sys
from typing import Any

from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn

from daidalos.nodes.nav2_map_server._saving import Wish, declare_parameters, save
from daidalos.nodes.runner import run


class MapSaver(LifecycleNode):
    """Serves ``~/save_map``; parameters are Nav2's."""

    def __init__(self, node_name: str = "map_saver", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        declare_parameters(self)
        self._active = False

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Serve."""
        from nav2_msgs.srv import SaveMap

        self._service = self.create_service(SaveMap, "~/save_map", self._on_save)
        return super().on_configure(state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Save from now on."""
        self._active = True
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Save nothing any more."""
        self._active = False
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Serve no more."""
        self.destroy_service(self._service)
        return super().on_cleanup(state)

    async def _on_save(self, request: Any, response: Any) -> Any:
        if not self._active:
            self.get_logger().error("Received save_map request but not in ACTIVE state, ignoring!")
            return response
        wish = Wish(
            request.map_topic or "map",
            request.map_url,
            request.map_mode,
            request.image_format,
            request.occupied_thresh,
            request.free_thresh,
        )
        response.result = await save(self, wish)
        return response


def main() -> int:
    """Run the node."""
    return run(MapSaver)


if __name__ == "__main__":
    sys.exit(main())

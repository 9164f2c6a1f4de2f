"""`map_and_localization_slam_toolbox_node`: mapping and localization, switched while it runs."""

from __future__ import annotations

from typing import Any

from daidalos.nodes.runner import run
from daidalos.nodes.slam_toolbox._localizing import LocalizingSlamToolbox
from daidalos.nodes.slam_toolbox._parameters import MapAndLocalizationParameters


class MapAndLocalizationSlamToolbox(LocalizingSlamToolbox):
    """Node that maps or localizes, as ``slam_toolbox/set_localization_mode`` says."""

    kind = MapAndLocalizationParameters

    def configure(self) -> None:
        """Start with what the parameter says, and serve the change."""
        from std_srvs.srv import SetBool

        settings = self.settings
        assert isinstance(settings, MapAndLocalizationParameters)
        self.localizing = settings.localization_on_configure
        super().configure()
        self.create_service(SetBool, "slam_toolbox/set_localization_mode", self._on_set_mode)

    def _on_set_mode(self, request: Any, response: Any) -> Any:
        self.localizing = request.data
        if self.slam is not None:
            with self.lock:
                self.slam.localizing = request.data
        response.success = True
        response.message = "localizing" if request.data else "mapping"
        self.get_logger().info(response.message)
        return response


def main() -> int:
    """Run the node."""
    return run(MapAndLocalizationSlamToolbox)

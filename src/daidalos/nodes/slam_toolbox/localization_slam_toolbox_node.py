"""`localization_slam_toolbox_node`: the robot's pose in a saved map."""

from __future__ import annotations

from daidalos.nodes.runner import run
from daidalos.nodes.slam_toolbox._localizing import LocalizingSlamToolbox


class LocalizationSlamToolbox(LocalizingSlamToolbox):
    """Node that localizes the robot in the pose graph that ``map_file_name`` names."""

    def configure(self) -> None:
        """Warn where no map is given."""
        super().configure()
        if not self.settings.map_file_name:
            self.get_logger().warning(
                "no map_file_name is given: slam_toolbox/deserialize_map has to load the map to be localized in"
            )


def main() -> int:
    """Run the node."""
    return run(LocalizationSlamToolbox)

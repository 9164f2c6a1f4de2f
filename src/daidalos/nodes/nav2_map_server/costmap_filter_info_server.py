"""`costmap_filter_info_server`: says what the mask of a costmap filter means and where it is published."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from rclpy.lifecycle import LifecycleState, TransitionCallbackReturn

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.managed import ManagedNode
from daidalos.nodes.parameters import declare
from daidalos.nodes.qos import LATCHED
from daidalos.nodes.runner import run


@dataclass(frozen=True)
class CostmapFilterInfoParameters(Parameters):
    """Parameters of the node, by their Nav2 names."""

    filter_info_topic: str = parameter(
        "costmap_filter_info", "Topic on which they are published.", not_empty=True, read_only=True
    )
    type: int = parameter(
        0, "Kind of filter: 0 keep-out and preferred lanes, 1 speed in percent, 2 speed in m/s, 3 binary.",
        minimum=0, maximum=255, read_only=True,
    )  # fmt: skip
    mask_topic: str = parameter("filter_mask", "Topic of the mask.", not_empty=True, read_only=True)
    base: float = parameter(0.0, "Value that a mask of 0 stands for.", read_only=True)
    multiplier: float = parameter(1.0, "Change of that value with the mask.", read_only=True)


class CostmapFilterInfoServer(ManagedNode):
    """Node that publishes one latched ``nav2_msgs/msg/CostmapFilterInfo``; its masks come from `map_server`."""

    def __init__(self, node_name: str = "costmap_filter_info_server", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._settings = declare(self, CostmapFilterInfoParameters)

    def configure(self) -> None:
        """Create the publisher."""
        from nav2_msgs.msg import CostmapFilterInfo

        self._publisher = self.create_publisher(CostmapFilterInfo, self._settings.filter_info_topic, LATCHED)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Publish."""
        from nav2_msgs.msg import CostmapFilterInfo

        p = self._settings
        message = CostmapFilterInfo(type=p.type, filter_mask_topic=p.mask_topic, base=p.base, multiplier=p.multiplier)
        message.header.stamp = self.get_clock().now().to_msg()
        self._publisher.publish(message)
        return super().on_activate(state)


def main() -> int:
    """Run the node."""
    return run(CostmapFilterInfoServer)

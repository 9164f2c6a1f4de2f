"""Topics and services of costmap filters."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rclpy.parameter import Parameter

from daidalos.common.errors import UserError
from daidalos.mapping.grid import OccupancyGrid
from daidalos.navigation.contracts import Input, Layer, Output, SpeedLimit
from daidalos.navigation.costmap.costmap_filter import FilterInfo, FilterMask
from daidalos.navigation.costmap.observation import CloudData
from daidalos.nodes.conversions import grid_array, pose2_of
from daidalos.nodes.qos import LATCHED

if TYPE_CHECKING:
    from daidalos.nodes.nav2_costmap_2d._costmap_node import CostmapNode


def occupancy_grid(message: Any) -> OccupancyGrid:
    """Return the grid of a ``nav_msgs/msg/OccupancyGrid``.

    Raises
    ------
    UserError
        The message contradicts itself.
    """
    x, y, yaw = (float(value) for value in pose2_of(message.info.origin))
    return OccupancyGrid(grid_array(message), message.info.resolution, (x, y, yaw), message.header.frame_id)


def listen_to_filter_info(node: CostmapNode, listened: Input) -> None:
    """Subscribe to the information about a filter's mask, and to the mask that the latest one names."""
    from nav2_msgs.msg import CostmapFilterInfo

    masks: list[Any] = []

    def take(message: Any) -> None:
        info = FilterInfo(message.type, message.filter_mask_topic, message.base, message.multiplier)
        with node.lock:
            mask = listened.take(info)
        if mask is not None:
            while masks:
                node.destroy_subscription(masks.pop())
            masks.append(_listen_to_mask(node, mask))

    node.create_subscription(CostmapFilterInfo, node.outer_topic(listened.topic), take, LATCHED)


def _listen_to_mask(node: CostmapNode, listened: Input) -> Any:
    """Return a subscription to a filter's mask."""
    from nav_msgs.msg import OccupancyGrid as GridMessage

    def take(message: Any) -> None:
        try:
            mask = FilterMask(occupancy_grid(message), message.header.frame_id)
            with node.lock:
                listened.take(mask)
        except UserError as error:
            node.get_logger().error(str(error))

    return node.create_subscription(GridMessage, node.outer_topic(listened.topic), take, LATCHED)


def output_publisher(node: CostmapNode, layer: Layer, output: Output) -> Callable[[], None]:
    """Return a function that publishes what an output of a layer gives, while the layer is enabled."""
    from nav2_msgs.msg import SpeedLimit as SpeedLimitMessage
    from sensor_msgs.msg import PointCloud2
    from sensor_msgs_py.point_cloud2 import create_cloud_xyz32
    from std_msgs.msg import Bool, Header

    def speed_limit(limit: SpeedLimit) -> Any:
        header = Header(frame_id=node.global_frame, stamp=node.get_clock().now().to_msg())
        return SpeedLimitMessage(header=header, percentage=limit.percentage, speed_limit=limit.value)

    def state(value: bool) -> Any:
        return Bool(data=value)

    def cloud(value: CloudData) -> Any:
        header = Header(frame_id=node.global_frame, stamp=node.get_clock().now().to_msg())
        return create_cloud_xyz32(header, value.points)

    kinds: dict[type, tuple[Any, Callable[[Any], Any]]] = {
        SpeedLimit: (SpeedLimitMessage, speed_limit),
        bool: (Bool, state),
        CloudData: (PointCloud2, cloud),
    }
    kind, message = kinds[output.type]
    topic = output.topic if output.type is CloudData else node.outer_topic(output.topic)
    publisher = node.create_publisher(kind, topic, 10)

    def publish() -> None:
        with node.lock:
            value = output.give() if layer.enabled else None
        if value is not None:
            publisher.publish(message(value))

    return publish


def serve_toggle(node: CostmapNode, name: str) -> None:
    """Create the service ``<name>/toggle_filter``, which sets the parameter ``<name>.enabled``."""
    from std_srvs.srv import SetBool

    def toggle(request: Any, response: Any) -> Any:
        (result,) = node.set_parameters([Parameter(f"{name}.enabled", value=bool(request.data))])
        response.success = result.successful
        response.message = result.reason or ("Enabled" if request.data else "Disabled")
        return response

    node.create_service(SetBool, f"{name}/toggle_filter", toggle)

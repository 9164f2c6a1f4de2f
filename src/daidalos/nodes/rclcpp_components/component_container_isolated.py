"""`component_container_isolated`: `component_container` with a thread for each node."""

from daidalos.nodes.rclcpp_components.component_container import main as main

"""`component_container_mt`: `component_container` with a thread for each node."""

import sys

from daidalos.nodes.rclcpp_components.component_container import main

if __name__ == "__main__":
    sys.exit(main())

"""`component_container_mt`: the same as `component_container`, whose nodes have threads of their own."""

import sys

from daidalos.nodes.rclcpp_components.component_container import main

if __name__ == "__main__":
    sys.exit(main())

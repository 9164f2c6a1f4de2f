"""Extension of launch files in markup for ROS; importing this module registers it."""

from .actions import composable_node_container as composable_node_container
from .actions import lifecycle_node as lifecycle_node
from .actions import load_composable_nodes as load_composable_nodes
from .actions import node as node
from .actions import push_ros_namespace as push_ros_namespace
from .actions import ros_timer as ros_timer
from .actions import set_parameter as set_parameter
from .actions import set_parameters_from_file as set_parameters_from_file
from .actions import set_remap as set_remap
from .actions import set_ros_log_dir as set_ros_log_dir
from .actions import set_use_sim_time as set_use_sim_time
from .substitutions import executable_in_package as executable_in_package
from .substitutions import find_package as find_package
from .substitutions import parameter as parameter

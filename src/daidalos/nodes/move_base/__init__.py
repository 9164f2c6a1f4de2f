"""move_base of ROS 1: planner, controller, costmaps and recoveries as one node."""

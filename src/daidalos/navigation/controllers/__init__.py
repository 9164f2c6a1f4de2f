"""Controllers that follow a path and avoid the obstacles of the local costmap."""

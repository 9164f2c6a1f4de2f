"""Ways from a pose to a goal over a costmap."""

"""Action servers to try behaviours with."""

from py_trees_ros.mock import actions as actions
from py_trees_ros.mock import dock as dock

"""Behaviours and behaviour trees of py_trees with topics, services, actions and transforms."""

from py_trees_ros import action_clients as action_clients
from py_trees_ros import battery as battery
from py_trees_ros import blackboard as blackboard
from py_trees_ros import conversions as conversions
from py_trees_ros import exceptions as exceptions
from py_trees_ros import mock as mock
from py_trees_ros import publishers as publishers
from py_trees_ros import subscribers as subscribers
from py_trees_ros import transforms as transforms
from py_trees_ros import trees as trees
from py_trees_ros import utilities as utilities
from py_trees_ros import visitors as visitors

"""Questions about nodes."""

# A function with the name of its module: the function is what the package offers.
from .matches_node_name import matches_node_name as matches_node_name

"""Questions about nodes with a life cycle."""

from ..matchers.matches_node_name import matches_node_name as matches_node_name

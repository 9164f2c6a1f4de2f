from . import lifecycle as lifecycle
from . import matchers as matchers
from .matchers import matches_node_name as matches_node_name

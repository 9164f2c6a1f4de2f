from .change_state import ChangeState as ChangeState
from .lifecycle_node_matchers import matches_node_name as matches_node_name
from .state_transition import StateTransition as StateTransition

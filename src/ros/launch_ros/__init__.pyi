from . import actions as actions
from . import descriptions as descriptions
from . import event_handlers as event_handlers
from . import events as events
from . import parameter_descriptions as parameter_descriptions
from . import ros_adapters as ros_adapters
from . import substitutions as substitutions
from . import utilities as utilities

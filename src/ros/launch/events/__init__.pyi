from . import matchers as matchers
from . import process as process
from .execution_complete import ExecutionComplete as ExecutionComplete
from .include_launch_description import IncludeLaunchDescription as IncludeLaunchDescription
from .matchers import matches_action as matches_action
from .shutdown import Shutdown as Shutdown
from .timer_event import TimerEvent as TimerEvent

from .event_named import event_named as event_named
from .on_action_event_base import OnActionEventBase as OnActionEventBase
from .on_execution_complete import OnExecutionComplete as OnExecutionComplete
from .on_include_launch_description import OnIncludeLaunchDescription as OnIncludeLaunchDescription
from .on_process_exit import OnProcessExit as OnProcessExit
from .on_process_io import OnProcessIO as OnProcessIO
from .on_process_start import OnProcessStart as OnProcessStart
from .on_shutdown import OnShutdown as OnShutdown

"""Hierarchical and concurrent state machines."""

from smach.concurrence import Concurrence as Concurrence
from smach.container import Container as Container
from smach.exceptions import InvalidConstructionError as InvalidConstructionError
from smach.exceptions import InvalidStateError as InvalidStateError
from smach.exceptions import InvalidTransitionError as InvalidTransitionError
from smach.exceptions import InvalidUserCodeError as InvalidUserCodeError
from smach.exceptions import SmachError as SmachError
from smach.iterator import Iterator as Iterator
from smach.log import logdebug as logdebug
from smach.log import logerr as logerr
from smach.log import loginfo as loginfo
from smach.log import logwarn as logwarn
from smach.log import set_loggers as set_loggers
from smach.sequence import Sequence as Sequence
from smach.state import CBState as CBState
from smach.state import State as State
from smach.state_machine import StateMachine as StateMachine
from smach.user_data import Const as Const
from smach.user_data import Remapper as Remapper
from smach.user_data import UserData as UserData
from smach.user_data import get_const as get_const
from smach.util import CBInterface as CBInterface
from smach.util import cb_interface as cb_interface
from smach.util import has_smach_interface as has_smach_interface
from smach.util import is_shutdown as is_shutdown
from smach.util import set_shutdown_check as set_shutdown_check

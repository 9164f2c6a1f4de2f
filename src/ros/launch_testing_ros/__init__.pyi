from . import actions as actions
from . import pytest as pytest
from . import tools as tools
from .data_republisher import DataRepublisher as DataRepublisher
from .message_pump import MessagePump as MessagePump
from .test_runner import LaunchTestRunner as LaunchTestRunner
from .wait_for_topics import WaitForTopics as WaitForTopics

"""Reporting the state of a node's hardware and topics on ``/diagnostics``."""

from ._diagnostic_status_wrapper import DiagnosticStatusWrapper as DiagnosticStatusWrapper
from ._diagnostic_updater import CompositeDiagnosticTask as CompositeDiagnosticTask
from ._diagnostic_updater import DiagnosticTask as DiagnosticTask
from ._diagnostic_updater import DiagnosticTaskVector as DiagnosticTaskVector
from ._diagnostic_updater import FunctionDiagnosticTask as FunctionDiagnosticTask
from ._diagnostic_updater import Updater as Updater
from ._publisher import DiagnosedPublisher as DiagnosedPublisher
from ._publisher import HeaderlessTopicDiagnostic as HeaderlessTopicDiagnostic
from ._publisher import TopicDiagnostic as TopicDiagnostic
from ._update_functions import FrequencyStatus as FrequencyStatus
from ._update_functions import FrequencyStatusParam as FrequencyStatusParam
from ._update_functions import Heartbeat as Heartbeat
from ._update_functions import TimeStampStatus as TimeStampStatus
from ._update_functions import TimeStampStatusParam as TimeStampStatusParam

from .keep_alive_proc import KeepAliveProc as KeepAliveProc
from .proc_lookup import NO_CMD_ARGS as NO_CMD_ARGS
from .proc_lookup import NoMatchingProcessException as NoMatchingProcessException
from .proc_lookup import resolveProcesses as resolveProcesses

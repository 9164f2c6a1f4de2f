"""The event that stops processes."""

from .process_targeted_event import ProcessTargetedEvent


class ShutdownProcess(ProcessTargetedEvent):
    """Processes are to stop: by SIGINT first, then by SIGTERM and SIGKILL; parameters as for its base."""

    name = "launch.events.process.ShutdownProcess"

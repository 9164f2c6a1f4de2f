"""Errors of behaviour trees in a graph."""


class MultipleFoundError(Exception):
    """Error of a search that finds more than one."""


class NotFoundError(Exception):
    """Error of a search that finds nothing."""


class NotReadyError(Exception):
    """Error of what is used before its `setup`."""


class ServiceError(Exception):
    """Error of a service call."""


class TimedOutError(Exception):
    """Error of what lasts too long."""

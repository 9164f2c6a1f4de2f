"""Errors of what a client sends."""


class InvalidArgumentException(Exception):
    """Error of a field with a value of the wrong kind."""


class MissingArgumentException(Exception):
    """Error of a message without a field that it needs."""


class NotAllowedException(Exception):
    """Error of a name that the server's patterns leave out, or of more than one client may have."""

"""The base of all events."""


class Event:
    """Something that happened; event handlers react to it."""

    name = "launch.Event"

"""The base of all events."""


class Event:
    """Base of events, which event handlers react to."""

    name = "launch.Event"

"""Service introspection: a service's requests and responses as messages on ``<service>/_service_event``."""

from enum import IntEnum


class ServiceIntrospectionState(IntEnum):
    """Content of service introspection."""

    OFF = 0
    METADATA = 1
    CONTENTS = 2

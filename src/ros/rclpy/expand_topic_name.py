"""From relative names to full ones."""

from rclpy.exceptions import InvalidTopicNameException
from rclpy.impl import names
from rclpy.validate_namespace import validate_namespace
from rclpy.validate_node_name import validate_node_name


def expand_topic_name(topic_name: str, node_name: str, node_namespace: str) -> str:
    """Return the full name of a topic of a node; nothing is remapped.

    Raises
    ------
    InvalidTopicNameException, InvalidNodeNameException, InvalidNamespaceException
        When a name breaks the rules.
    """
    fault = names.topic_name_error(topic_name)
    if fault:
        raise InvalidTopicNameException(topic_name, *fault)
    validate_node_name(node_name)
    validate_namespace(node_namespace)
    try:
        return names.expand(topic_name, node_name, node_namespace)
    except names.UnknownSubstitution as error:
        raise InvalidTopicNameException(topic_name, str(error), topic_name.index("{")) from None

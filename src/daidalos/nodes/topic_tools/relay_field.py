"""`relay_field`: publishes fields of a topic's messages in messages of another type."""

from __future__ import annotations

from typing import Any

from daidalos.common.documents import DocumentError, parse_yaml
from daidalos.nodes.runner import UserError
from daidalos.nodes.topic_tools._expressions import evaluate, parse, parser, run_expression

_EXAMPLE = """Fields are given as YAML in which m stands for the message:
ros2 run topic_tools relay_field /chatter /header std_msgs/Header "{stamp: {sec: 0, nanosec: 0}, frame_id: m.data}" """


def fill(template: Any, message: Any) -> Any:
    """Return a template whose texts that speak of ``m`` are evaluated."""
    if isinstance(template, dict):
        return {name: fill(value, message) for name, value in template.items()}
    if isinstance(template, list):
        return [fill(value, message) for value in template]
    if isinstance(template, str) and (template == "m" or "m." in template or "m[" in template):
        return evaluate(template, {"m": message})
    return template


def main() -> int:
    """Run the node."""
    made = parser("relay_field", _EXAMPLE)
    made.add_argument("expression", help="Fields of the output as YAML")
    arguments = parse(made)

    def apply(message: Any, kind: Any) -> Any:
        from rosidl_runtime_py.set_message import set_message_fields

        output = kind()
        try:
            template = parse_yaml(arguments.expression)
        except DocumentError as error:
            raise UserError(f"the fields are not valid YAML: {error.described}") from None
        try:
            set_message_fields(output, fill(template, message))
        except (AttributeError, TypeError, ValueError, AssertionError) as error:
            raise UserError(f"the fields do not fit {arguments.output_type}: {error}") from None
        return output

    return run_expression("relay_field", arguments, apply)

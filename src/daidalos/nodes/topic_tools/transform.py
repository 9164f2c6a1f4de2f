"""`transform`: publishes the values of a Python expression over a topic's messages."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Any

from daidalos.nodes.runner import UserError
from daidalos.nodes.topic_tools._expressions import evaluate, parse, parser, run_expression

_EXAMPLE = """The message, or its field, is m:
ros2 run topic_tools transform /imu --field orientation /norm std_msgs/Float64
"std_msgs.msg.Float64(data=numpy.sqrt(numpy.sum(numpy.array([m.x, m.y, m.z, m.w]))))" --import std_msgs numpy"""


def imported(names: Sequence[str]) -> dict[str, Any]:
    """Return modules by the name that an expression calls them by."""
    modules = {}
    for name in names:
        try:
            import_module(name)
            if name.endswith("_msgs"):
                import_module(f"{name}.msg")  # expressions write std_msgs.msg.String
        except ImportError as error:
            raise UserError(f"cannot import '{name}': {error}") from None
        modules[name.partition(".")[0]] = sys.modules[name.partition(".")[0]]
    return modules


def field_of(message: Any, path: str) -> Any:
    """Return a field, given as ``pose.position`` or ``pose/position``, with ``[i]`` for elements."""
    return evaluate(f"m.{path.strip('/').replace('/', '.')}", {"m": message}) if path else message


def main() -> int:
    """Run the node."""
    made = parser("transform", _EXAMPLE)
    made.add_argument("expression", nargs="?", default="m", help="Python expression of m")
    made.add_argument("-i", "--import", dest="modules", nargs="+", default=[], help="Modules that it needs")
    made.add_argument("--field", default="", help="The field of the message that is to be m")
    arguments = parse(made)
    names: dict[str, Any] = {}

    def apply(message: Any, kind: Any) -> Any:
        if not names:
            names.update(imported([*arguments.modules, kind.__module__.partition(".")[0]]))
        value = evaluate(arguments.expression, names | {"m": field_of(message, arguments.field)})
        if isinstance(value, kind):
            return value
        output = kind()
        fields = list(kind.get_fields_and_field_types())
        values = value if isinstance(value, (list, tuple)) and len(fields) > 1 else [value]
        try:
            for name, each in zip(fields, values, strict=True):
                setattr(output, name, each)
        except (AttributeError, TypeError, ValueError, AssertionError) as error:
            raise UserError(f"the value does not fit {arguments.output_type}: {error}") from None
        return output

    return run_expression("transform", arguments, apply)

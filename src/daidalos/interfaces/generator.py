"""Generator of the Python package of an interface package, laid out as rosidl does.

Runs when the project is built, and when `colcon` builds a user's package; needs the standard library only.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from daidalos.interfaces.definition import Action, Interface, Message, Service, messages_of
from daidalos.interfaces.description import Lookup, describe
from daidalos.interfaces.message_source import alias, message_source, short_name


def write_package(package: str, interfaces: Iterable[Interface], lookup: Lookup, target: Path) -> list[Path]:
    """Write the package to its folder in `target`, which is on the import path; see `write_modules`."""
    return write_modules(package, interfaces, lookup, target / package)


def write_modules(package: str, interfaces: Iterable[Interface], lookup: Lookup, folder: Path) -> list[Path]:
    """Write the Python package of an interface package, with one module per interface.

    Parameters
    ----------
    package
        The ROS package's name.
    interfaces
        Its definitions.
    lookup
        Finds the definitions of referenced types.
    folder
        The Python package's folder.

    Returns
    -------
    list of Path
        The files of the package; those whose content did not change are left untouched.
    """
    written = [_write(folder / "__init__.py", f'"""Interfaces of the ROS package {package}."""\n')]
    by_kind: dict[str, list[Interface]] = {}
    for interface in interfaces:
        by_kind.setdefault(interface.name.split("/")[1], []).append(interface)
    for kind, members in by_kind.items():
        for member in members:
            module = module_name(short_name(member.name))
            written.append(_write(folder / kind / f"{module}.py", module_source(member, lookup)))
        written.append(_write(folder / kind / "__init__.py", _init_source(package, kind, members)))
    written.append(_write(folder / "py.typed", ""))
    return written


def module_name(name: str) -> str:
    """Return the module name that rosidl gives an interface: ``TFMessage`` -> ``_tf_message``."""
    name = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", name)
    return "_" + re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", name).lower()


def module_source(interface: Interface, lookup: Lookup) -> str:
    """Return the source text of the module with the interface's classes."""
    own = {message.name for message in messages_of(interface)}
    lines = [
        f'"""{interface.name}: generated from its definition; changes here are lost."""',
        "",
        "from __future__ import annotations",
        "",
        "from typing import Any",
        "",
        "from daidalos.interfaces import message as _m",
    ]
    lines += sorted({_import(base) for m in messages_of(interface) for base in m.nested() if base not in own})
    for message in messages_of(interface):
        lines += ["", "", *message_source(message, lookup)]
    if isinstance(interface, Service):
        lines += ["", "", *_service_source(interface, lookup)]
    elif isinstance(interface, Action):
        for service in (interface.send_goal, interface.get_result):
            lines += ["", "", *_service_source(service, lookup)]
        lines += ["", "", *_action_source(interface, lookup)]
    return "\n".join(lines) + "\n"


def _write(path: Path, text: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.is_file() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
    return path


def _init_source(package: str, kind: str, members: list[Interface]) -> str:
    """Return an ``__init__`` that imports each module on first access to its class."""
    exports = {module_name(short_name(member.name)): list(_exports(member)) for member in members}
    modules = {name: module for module, names in exports.items() for name in names}
    lines = [
        f'"""The {kind} interfaces of {package}, imported when they are used."""',
        "",
        "from importlib import import_module as _import_module",
        "from typing import TYPE_CHECKING as _TYPE_CHECKING",
        "",
        "if _TYPE_CHECKING:",
        *(f"    from .{module} import {', '.join(names)}" for module, names in exports.items()),
        "",
        "_MODULES = {",
        *(f"    {name!r}: {module!r}," for name, module in modules.items()),
        "}",
        f"__all__ = {sorted(modules)!r}",
        "",
        "",
        "def __getattr__(name):",
        "    module = _MODULES.get(name)",
        "    if module is None:",
        "        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')",
        "    value = getattr(_import_module(f'{__name__}.{module}'), name)",
        "    globals()[name] = value",
        "    return value",
        "",
        "",
        "def __dir__():",
        "    return sorted({*globals(), *_MODULES})",
    ]
    return "\n".join(lines) + "\n"


def _exports(interface: Interface) -> Iterator[str]:
    """Yield the class names that ROS 2 exports in the package's ``__init__``, with their parts."""
    yield short_name(interface.name)
    if isinstance(interface, Message):
        return
    for message in interface.messages:
        yield short_name(message.name)
    if isinstance(interface, Action):
        yield short_name(interface.send_goal.name)
        yield short_name(interface.get_result.name)


def _import(base: str) -> str:
    package, kind, short = base.split("/")
    module = module_name(short if kind == "msg" else short.partition("_")[0])
    return f"from {package}.{kind}.{module} import {short} as {alias(base)}"


def _service_source(service: Service, lookup: Lookup) -> Iterator[str]:
    short = short_name(service.name)
    yield f"class {short}(_m.Service):"
    yield f'    """{service.name}: request, response and the event of its introspection."""'
    yield ""
    yield f"    _TYPE_NAME = {service.name!r}"
    yield f"    _TYPE_HASH = {describe(service, lookup).type_hash()!r}"
    yield f"    Request = {short_name(service.request.name)}"
    yield f"    Response = {short_name(service.response.name)}"
    yield f"    Event = {short_name(service.event.name)}"


def _action_source(action: Action, lookup: Lookup) -> Iterator[str]:
    short = short_name(action.name)
    yield "from action_msgs.msg._goal_status_array import GoalStatusArray as _GoalStatusArray  # noqa: E402"
    yield "from action_msgs.srv._cancel_goal import CancelGoal as _CancelGoal  # noqa: E402"
    yield ""
    yield ""
    yield f"class {short}(_m.Action):"
    yield f'    """{action.name}: goal, result, feedback and the interfaces built from them."""'
    yield ""
    yield f"    _TYPE_NAME = {action.name!r}"
    yield f"    _TYPE_HASH = {describe(action, lookup).type_hash()!r}"
    yield f"    Goal = {short_name(action.goal.name)}"
    yield f"    Result = {short_name(action.result.name)}"
    yield f"    Feedback = {short_name(action.feedback.name)}"
    yield ""
    yield "    class Impl:"
    yield '        """The services and messages that carry the action."""'
    yield ""
    yield f"        SendGoalService = {short_name(action.send_goal.name)}"
    yield f"        GetResultService = {short_name(action.get_result.name)}"
    yield f"        FeedbackMessage = {short_name(action.feedback_message.name)}"
    yield "        CancelGoalService = _CancelGoal"
    yield "        GoalStatusMessage = _GoalStatusArray"

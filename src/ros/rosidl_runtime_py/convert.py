"""Messages as dictionaries, YAML and CSV."""

from __future__ import annotations

import array
from collections import OrderedDict
from collections.abc import Mapping
from typing import Any

from daidalos.interfaces.message import Message

_NO_LINE_BREAKS = 2**31 - 1


def get_message_slot_types(msg: Any) -> OrderedDict[str, Any]:
    """Return the fields of a message with the classes that describe their types."""
    return OrderedDict(zip(msg.get_fields_and_field_types(), msg.SLOT_TYPES, strict=True))


def message_to_ordereddict(
    msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False
) -> OrderedDict[str, Any]:
    """Return a message as nested dictionaries.

    Parameters
    ----------
    msg
        The message.
    truncate_length
        Shorten lists, bytes and strings that are longer than this.
    no_arr, no_str
        Say the length of lists or strings instead of their content.
    """
    result: OrderedDict[str, Any] = OrderedDict()
    for name, kind in msg.get_fields_and_field_types().items():
        result[name] = _convert_value(
            getattr(msg, name), field_type=kind, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str
        )
    return result


def _convert_value(
    value: Any,
    *,
    field_type: str | None = None,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
) -> Any:
    """Return a value of a message, or a container of such values, as Python's own."""
    options: dict[str, Any] = {"truncate_length": truncate_length, "no_arr": no_arr, "no_str": no_str}
    if isinstance(value, Message):
        return message_to_ordereddict(value, **options)
    if isinstance(value, bytes):
        return _truncated("".join(map(chr, value)), truncate_length) if len(value) > 1 else ord(value)
    if isinstance(value, str):
        return f"<string length: <{len(value)}>>" if no_str else _truncated(str.__str__(value), truncate_length)
    if isinstance(value, (int, float)):
        return _plain_number(value)
    if isinstance(value, Mapping):
        pairs = ((key, _convert_value(item, **options)) for key, item in value.items())
        return OrderedDict(pairs) if isinstance(value, OrderedDict) else dict(pairs)
    return _convert_sequence(value, field_type or "", options)


def _truncated(text: str, limit: int | None) -> str:
    return f"{text[:limit]}..." if limit is not None and len(text) > limit else text


def _plain_number(value: float) -> float:
    """Return a number as Python's own, also where a message holds one of NumPy's or of an enumeration."""
    kind = next(kind for kind in (bool, int, float) if isinstance(value, kind))
    return kind(value)


def _convert_sequence(values: Any, kind: str, options: dict[str, Any]) -> Any:
    inner = _value_type(kind)
    if options["no_arr"]:
        return _summary(values, kind, inner)
    limit = options["truncate_length"]
    cut = limit is not None and len(values) > limit
    shown = values[:limit] if cut else values
    if hasattr(shown, "tolist"):
        items = shown.tolist()
    else:
        items = [_convert_value(value, field_type=inner, **options) for value in shown]
    items += ["..."] if cut else []
    return tuple(items) if isinstance(values, tuple) else items


def _value_type(kind: str) -> str:
    """Return the type of a sequence's items: ``double`` for ``sequence<double, 3>`` and ``double[3]``."""
    if kind.startswith("sequence<"):
        inner = kind.removeprefix("sequence<").removesuffix(">")
        head, comma, bound = inner.rpartition(", ")
        return head if comma and bound.isdigit() else inner
    return kind.partition("[")[0]


def _summary(values: Any, kind: str, inner: str) -> str:
    is_array = kind.endswith("]")
    name = inner
    if "/" in inner:
        package, _, short = inner.partition("/")
        name = f"{package}/{_namespace(short)}/{short}"
    bound = kind.removesuffix(">").rpartition(", ")[2]
    limit = f"[{bound}]" if bound.isdigit() and not is_array else ""
    length = f"[{len(values)}]" if is_array else f"{limit}, length: {len(values)}"
    return f"<{'array' if is_array else 'sequence'} type: {name}{length}>"


def _namespace(short: str) -> str:
    """Return where a type is declared: names of messages hold no underscore, those of parts of others end in one."""
    _, *parts = short.split("_")
    if not parts:
        return "msg"
    return "srv" if len(parts) == 1 and parts[0] in ("Request", "Response", "Event") else "action"


def message_to_yaml(
    msg: Any,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
) -> str:
    """Return a message as YAML; the options are those of `message_to_ordereddict`.

    With `flow_style`, lists stand in brackets on one line.
    """
    import yaml

    content = message_to_ordereddict(msg, truncate_length=truncate_length, no_arr=no_arr, no_str=no_str)
    return yaml.dump(
        _FlowLists.applied(content) if flow_style else _plain_dicts(content),
        Dumper=_dumper(),
        allow_unicode=True,
        width=_NO_LINE_BREAKS,
        default_flow_style=False,
        sort_keys=False,
    )


class _FlowLists(list[Any]):
    """A list that is written in brackets."""

    @classmethod
    def applied(cls, value: Any) -> Any:
        """Return a value with every list in it made such a list."""
        if isinstance(value, dict):
            return {key: cls.applied(item) for key, item in value.items()}
        return cls(cls.applied(item) for item in value) if isinstance(value, list) else value


def _plain_dicts(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain_dicts(item) for key, item in value.items()}
    return [_plain_dicts(item) for item in value] if isinstance(value, list) else value


def _dumper() -> Any:
    """Return the dumper, made once: PyYAML is imported only when YAML is written."""
    global _DUMPER
    if _DUMPER is None:
        import yaml

        class Dumper(getattr(yaml, "CSafeDumper", yaml.SafeDumper)):  # type: ignore[misc]
            def ignore_aliases(self, data: Any) -> bool:
                return True

        Dumper.add_representer(
            _FlowLists,
            lambda dumper, data: dumper.represent_sequence("tag:yaml.org,2002:seq", data, flow_style=True),
        )
        _DUMPER = Dumper
    return _DUMPER


_DUMPER: Any = None


def message_to_csv(msg: Any, *, truncate_length: int | None = None, no_arr: bool = False, no_str: bool = False) -> str:
    """Return a message's values separated by commas; the options are those of `message_to_ordereddict`."""
    return ",".join(
        _csv(getattr(msg, name), kind, truncate_length, no_arr, no_str)
        for name, kind in msg.get_fields_and_field_types().items()
    )


def _csv(value: Any, kind: str, limit: int | None, no_arr: bool, no_str: bool) -> str:
    if isinstance(value, Message):
        return message_to_csv(value, truncate_length=limit, no_arr=no_arr, no_str=no_str)
    if isinstance(value, (str, bytes)):
        if isinstance(value, str) and no_str:
            return f"<string length: <{len(value)}>>"
        shown = value if limit is None or len(value) <= limit else f"{value[:limit]!s}..."
        return str(shown)
    if isinstance(value, (int, float)):
        return str(_plain_number(value))
    if not isinstance(value, (list, tuple, array.array)) and not hasattr(value, "tolist"):
        return str(value)
    inner = _value_type(kind)
    if no_arr:
        return _summary(value, kind, inner)
    cut = limit is not None and len(value) > limit
    items = value[:limit] if cut else value
    texts = [
        _csv(item, inner, limit, no_arr, no_str) for item in (items.tolist() if hasattr(items, "tolist") else items)
    ]
    return ",".join([*texts, "..."] if cut else texts)

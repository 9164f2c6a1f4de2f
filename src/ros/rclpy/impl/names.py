"""ROS 2's rules for names: what is valid, how a relative name becomes a full one, how names are replaced.

The rules are those of the ROS 2 design article "Topic and Service name mapping to DDS".
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

MAX_NODE_NAME = 255
MAX_NAME = 247
_SUBSTITUTION = re.compile(r"\{([^{}]*)\}")
_SUBSTITUTIONS = ("node", "ns", "namespace")

Fault = tuple[str, int]
"""What is wrong with a name, and at which character."""


def node_name_error(name: str) -> Fault | None:
    """Check a node's name."""
    if not name:
        return "node name must not be empty", 0
    fault = _first_bad(name, r"[A-Za-z0-9_]", "node name must not contain characters other than alphanumerics or '_'")
    if fault:
        return fault
    if name[0].isdigit():
        return "node name must not start with a number", 0
    if len(name) > MAX_NODE_NAME:
        return f"node name length should not exceed '{MAX_NODE_NAME}'", MAX_NODE_NAME - 1
    return None


def namespace_error(namespace: str) -> Fault | None:
    """Check a namespace, which must be absolute."""
    if not namespace:
        return "namespace must not be empty", 0
    if namespace[0] != "/":
        return "namespace must be absolute, it must lead with a '/'", 0
    if namespace == "/":
        return None
    fault = full_name_error(namespace)
    if fault:
        return fault[0].replace("topic name", "namespace"), fault[1]
    return None


def full_name_error(name: str) -> Fault | None:
    """Check a fully qualified topic or service name."""
    if not name:
        return "topic name must not be empty", 0
    if name[0] != "/":
        return "topic name must be absolute, it must lead with a '/'", 0
    if name.endswith("/"):
        return "topic name must not end with a '/'", len(name) - 1
    fault = _first_bad(
        name, r"[A-Za-z0-9_/]", "topic name must not contain characters other than alphanumerics, '_', or '/'"
    )
    if fault:
        return fault
    if "//" in name:
        return "topic name must not contain repeated '/'", name.index("//") + 1
    token = re.search(r"/[0-9]", name)
    if token:
        return "topic name must not have a token that starts with a number", token.start() + 1
    if len(name) > MAX_NAME:
        return f"topic name length should not exceed '{MAX_NAME}'", MAX_NAME - 1
    return None


def topic_name_error(name: str) -> Fault | None:
    """Check a topic or service name as a user writes it: relative, private or with substitutions."""
    if not name:
        return "topic name must not be empty string", 0
    if name[0].isdigit():
        return "topic name must not start with a number", 0
    if name.endswith("/"):
        return "topic name must not end with a '/'", len(name) - 1
    fault = _first_bad(
        name,
        r"[A-Za-z0-9_/~{}]",
        "topic name must not contain characters other than alphanumerics, '_', '~', '{', or '}'",
    )
    return fault or _tilde_error(name) or _brace_error(name) or _token_error(name)


def _tilde_error(name: str) -> Fault | None:
    position = name.find("~", 1)
    if position > 0:
        return "topic name must not have tilde '~' other than at the front", position
    if name.startswith("~") and len(name) > 1 and name[1] != "/":
        return "topic name must not have tilde '~' followed by characters other than '/'", 1
    return None


def _brace_error(name: str) -> Fault | None:
    depth = 0
    for i, char in enumerate(name):
        if char == "{":
            depth += 1
            start = i
        elif char == "}":
            depth -= 1
        if depth not in (0, 1):
            return "topic name must not have unbalanced curly braces '{}'", i
    if depth:
        return "topic name must not have unbalanced curly braces '{}'", start
    for match in _SUBSTITUTION.finditer(name):
        if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", match[1]):
            return "topic name has invalid substitution", match.start() + 1
    return None


def _token_error(name: str) -> Fault | None:
    if "//" in name:
        return "topic name must not contain repeated '/'", name.index("//") + 1
    token = re.search(r"/[0-9]", name)
    if token:
        return "topic name token must not start with a number", token.start() + 1
    return None


def _first_bad(name: str, allowed: str, message: str) -> Fault | None:
    for i, char in enumerate(name):
        if not re.match(allowed, char):
            return message, i
    return None


class UnknownSubstitution(ValueError):
    """A name contains ``{something}`` that has no meaning."""


def expand(name: str, node_name: str, namespace: str) -> str:
    """Return the full name of a topic or service of the node `namespace`/`node_name`.

    Raises
    ------
    UnknownSubstitution
        When braces enclose something other than ``node``, ``ns`` or ``namespace``.
    """
    values = {"node": node_name, "ns": namespace, "namespace": namespace}

    def replace(match: re.Match[str]) -> str:
        if match[1] not in values:
            raise UnknownSubstitution(f"unknown substitution '{match[0]}' in '{name}'")
        return values[match[1]]

    base = namespace.rstrip("/")
    if name.startswith("~"):
        name = f"{base}/{node_name}{name[1:]}"
    name = _SUBSTITUTION.sub(replace, name)
    if not name.startswith("/"):
        name = f"{base}/{name}"
    return name


def absolute_namespace(namespace: str) -> str:
    """Return a namespace with its leading slash and without a trailing one."""
    namespace = namespace if namespace.startswith("/") else f"/{namespace}"
    return namespace.rstrip("/") or "/"


@dataclass(frozen=True)
class RemapRule:
    """``node:kind://match:=replacement``.

    Attributes
    ----------
    kind
        "node", "ns", "topic", "service" or "any" (topics and services).
    match
        The name to replace; empty for "node" and "ns".
    replacement
        The new name.
    node
        Only the node of that name (not its namespace), or any where empty.
    """

    kind: str
    match: str
    replacement: str
    node: str = ""


def remap_node(rules: Iterable[RemapRule], name: str) -> str:
    """Return the node's new name."""
    for rule in rules:
        if rule.kind == "node" and rule.node in ("", name):
            return rule.replacement
    return name


def remap_namespace(rules: Iterable[RemapRule], name: str, namespace: str) -> str:
    """Return the new namespace of a node, given the name that it was created with."""
    for rule in rules:
        if rule.kind == "ns" and rule.node in ("", name):
            return rule.replacement
    return namespace


def remap_name(rules: Iterable[RemapRule], kind: str, full_name: str, node_name: str, namespace: str) -> str:
    """Return the new full name of a topic or service (`kind`) of a node."""
    for rule in rules:
        if rule.kind not in (kind, "any") or rule.node not in ("", node_name):
            continue
        if _matches(expand(rule.match, node_name, namespace), full_name):
            return expand(_filled(rule, full_name, node_name, namespace), node_name, namespace)
    return full_name


def _matches(pattern: str, name: str) -> bool:
    return re.fullmatch(_pattern(pattern), name) is not None


def _pattern(text: str) -> str:
    """Return the regular expression of a match side: ``*`` is one token, ``**`` any number of them."""
    parts = re.split(r"(\*\*|\*)", text)
    return "".join({"**": "(.*)", "*": "([^/]+)"}.get(part, re.escape(part)) for part in parts)


def _filled(rule: RemapRule, name: str, node_name: str, namespace: str) -> str:
    r"""Return the replacement with ``\1`` ... filled from what the wildcards matched."""
    match = re.fullmatch(_pattern(expand(rule.match, node_name, namespace)), name)
    if match is None or "\\" not in rule.replacement:
        return rule.replacement
    return match.expand(rule.replacement)

"""Access policies of enclaves, as XML (SROS 2's format 0.2.0) and as zenoh's access control."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from ros2cli.graph import is_hidden

from daidalos.cli.ros2.errors import CliError
from daidalos.transport.graph import EndpointKind, Graph, NodeInfo

_VERSION = "0.2.0"
_SECTIONS = {
    EndpointKind.SUBSCRIPTION: ("topics", "subscribe", "topic"),
    EndpointKind.PUBLISHER: ("topics", "publish", "topic"),
    EndpointKind.SERVICE: ("services", "reply", "service"),
    EndpointKind.CLIENT: ("services", "request", "service"),
}
_ACTION_PARTS = ("send_goal", "cancel_goal", "get_result", "feedback", "status")

# Message flows of publishers, subscriptions, servers and clients.
_FLOWS = {
    "publish": (("egress", ("put", "delete")), ("ingress", ("declare_subscriber",))),
    "subscribe": (("ingress", ("put", "delete")), ("egress", ("declare_subscriber",))),
    "reply": (("ingress", ("query",)), ("egress", ("reply", "declare_queryable"))),
    "request": (("egress", ("query",)), ("ingress", ("reply", "declare_queryable"))),
}


def policy_of(graph: Graph) -> str:
    """Return the policy that allows exactly what the nodes of a graph currently do."""
    root = ElementTree.Element("policy", version=_VERSION)
    enclaves = ElementTree.SubElement(root, "enclaves")
    nodes = [node for node in graph.nodes() if not is_hidden(node.full_name)]
    for path in sorted({node.enclave for node in nodes}):
        profiles = ElementTree.SubElement(ElementTree.SubElement(enclaves, "enclave", path=path), "profiles")
        for node in nodes:
            if node.enclave == path:
                _add_profile(profiles, graph, node)
    ElementTree.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"


def _add_profile(profiles: ElementTree.Element, graph: Graph, node: NodeInfo) -> None:
    profile = ElementTree.SubElement(profiles, "profile", ns=node.namespace, node=node.name)
    for kind, (section, permission, tag) in _SECTIONS.items():
        names = sorted({endpoint.name for endpoint in graph.endpoints_of(node, kind)})
        if names:
            group = ElementTree.SubElement(profile, section, {permission: "ALLOW"})
            for name in names:
                ElementTree.SubElement(group, tag).text = name


def access_control(file: Path, enclave: str) -> dict[str, Any]:
    """Return zenoh's access control for an enclave of a policy file.

    Raises
    ------
    CliError
        When the file cannot be read, is no policy, or says nothing of the enclave.
    """
    found = next((one for one in _read(file).iter("enclave") if one.get("path") == enclave), None)
    if found is None:
        raise CliError(f"{file}: there is no enclave with the path '{enclave}'")
    allowed: dict[str, set[str]] = {permission: set() for permission in _FLOWS}
    for profile in found.iter("profile"):
        for permission, name in _permissions(profile):
            allowed[permission].add(name)
    rules = [_common_rule()]
    for permission, names in allowed.items():
        rules += [_rule(permission, flow, messages, names) for flow, messages in _FLOWS[permission] if names]
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": rules,
        "subjects": [{"id": "everybody"}],
        "policies": [{"rules": [rule["id"] for rule in rules], "subjects": ["everybody"]}],
    }


def _read(file: Path) -> ElementTree.Element:
    try:
        root = ElementTree.parse(file).getroot()
    except OSError as error:
        raise CliError(f"{file}: {error.strerror}") from None
    except ElementTree.ParseError as error:
        raise CliError(f"{file}:{error.position[0]}: {error}") from None
    except LookupError as error:  # an encoding that Python does not know
        raise CliError(f"{file}:1: {error}") from None
    if root.tag != "policy":
        raise CliError(f"{file}: expected <policy>, found <{root.tag[:100]}>")
    return root


def _permissions(profile: ElementTree.Element) -> Iterator[tuple[str, str]]:
    """Yield (permission, full name) for everything that a profile allows."""
    namespace, node = profile.get("ns", "/"), profile.get("node", "")
    for group in profile:
        for permission in ("publish", "subscribe", "reply", "request", "call", "execute"):
            if group.get(permission) != "ALLOW":
                continue
            for entry in group:
                name = _full_name((entry.text or "").strip(), namespace, node)
                yield from _parts(permission, name)


def _parts(permission: str, name: str) -> Iterable[tuple[str, str]]:
    """Return a permission in terms of topics and services; actions consist of both."""
    if permission not in ("call", "execute"):
        return [(permission, name)]
    service, topic = ("request", "subscribe") if permission == "call" else ("reply", "publish")
    return [(topic if part in ("feedback", "status") else service, f"{name}/_action/{part}") for part in _ACTION_PARTS]


def _full_name(name: str, namespace: str, node: str) -> str:
    if name.startswith("/"):
        return name
    base = namespace.rstrip("/")
    return f"{base}/{node}/{name[2:]}" if name.startswith("~/") else f"{base}/{name}"


def _rule(permission: str, flow: str, messages: Iterable[str], names: Iterable[str]) -> dict[str, Any]:
    keys = [key for name in sorted(names) for key in (f"*/{name[1:]}/**", f"*/{name[1:]}/**/@adv/**")]
    return {
        "id": f"{permission}_{flow}",
        "permission": "allow",
        "flows": [flow],
        "messages": list(messages),
        "key_exprs": keys,
    }


def _common_rule() -> dict[str, Any]:
    """Return the rule for discovery, which is always allowed."""
    return {
        "id": "graph",
        "permission": "allow",
        "flows": ["egress", "ingress"],
        "messages": ["liveliness_token", "liveliness_query", "declare_liveliness_subscriber", "reply"],
        "key_exprs": ["@ros2_lv/**", "**/@adv/**"],
    }


def enclave_paths(file: Path) -> list[str]:
    """Return the enclaves of a policy file; see `access_control` for what it raises."""
    return [path for enclave in _read(file).iter("enclave") if (path := enclave.get("path"))]

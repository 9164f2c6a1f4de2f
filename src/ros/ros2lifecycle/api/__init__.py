"""Managed nodes, their states and their transitions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from ros2cli.services import call
from ros2node.api import get_node_names as get_all_node_names
from ros2service.api import get_service_names_and_types

_TRANSITION_S = 60.0
"""Timeout of a transition, in which nodes may load maps and open devices [s]."""


def get_node_names(*, node: Any, include_hidden_nodes: bool = False) -> list[Any]:
    """Return the managed nodes in the graph, in the form of `ros2node.api.get_node_names`.

    Parameters
    ----------
    node
        Who asks.
    include_hidden_nodes
        Whether those with a part that begins with an underscore are among them.
    """
    found = get_all_node_names(node=node, include_hidden_nodes=include_hidden_nodes)
    services = dict(get_service_names_and_types(node=node, include_hidden_services=include_hidden_nodes))
    return [one for one in found if "lifecycle_msgs/srv/GetState" in services.get(f"{one.full_name}/get_state", ())]


def call_get_states(*, node: Any, node_names: Iterable[str]) -> dict[str, Any]:
    """Return the states (`lifecycle_msgs/msg/State`) of managed nodes by name, or the error of the call.

    Parameters
    ----------
    node
        The rclpy node that asks.
    node_names
        Full names of the managed nodes.
    """
    from lifecycle_msgs.srv import GetState

    return {
        name: _result(node, GetState, f"{name}/get_state", GetState.Request(), "current_state") for name in node_names
    }


def call_get_available_transitions(*, node: Any, states: Mapping[str, Any]) -> dict[str, Any]:
    """Return the transitions (`lifecycle_msgs/msg/TransitionDescription`) that managed nodes can make, by name.

    Parameters
    ----------
    node
        The rclpy node that asks.
    states
        State of each node, from which its transitions start; None: from any state.
    """
    return _transitions(node, states, "get_available_transitions")


def call_get_transition_graph(*, node: Any, states: Mapping[str, Any]) -> dict[str, Any]:
    """Return the transitions of the state machines of managed nodes; see `call_get_available_transitions`."""
    return _transitions(node, states, "get_transition_graph")


def call_change_states(*, node: Any, transitions: Mapping[str, Any]) -> dict[str, Any]:
    """Trigger transitions of managed nodes; return by name whether they succeeded, or the error of the call.

    Parameters
    ----------
    node
        The rclpy node that asks.
    transitions
        Transition (`lifecycle_msgs/msg/Transition`) of each node.
    """
    from lifecycle_msgs.srv import ChangeState

    return {
        name: _result(
            node,
            ChangeState,
            f"{name}/change_state",
            ChangeState.Request(transition=transition),
            "success",
            answer_s=_TRANSITION_S,
        )
        for name, transition in transitions.items()
    }


def _transitions(node: Any, states: Mapping[str, Any], service: str) -> dict[str, Any]:
    from lifecycle_msgs.srv import GetAvailableTransitions

    found: dict[str, Any] = {}
    for name, state in states.items():
        request = GetAvailableTransitions.Request()
        result = _result(node, GetAvailableTransitions, f"{name}/{service}", request, "available_transitions")
        if state is not None and not isinstance(result, Exception):
            result = [one for one in result if one.start_state == state]
        found[name] = result
    return found


def _result(node: Any, kind: Any, service: str, request: Any, field: str, **options: Any) -> Any:
    """Return a field of a service's response, or the error of the call."""
    try:
        return getattr(call(node, kind, service, request, **options), field)
    except RuntimeError as error:
        return error

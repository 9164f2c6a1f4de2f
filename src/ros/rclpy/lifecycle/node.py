"""Managed nodes."""

from __future__ import annotations

import traceback
from typing import Any, NamedTuple

from daidalos.common.errors import UserError
from rclpy.callback_groups import CallbackGroup
from rclpy.impl.errors import RCLError
from rclpy.lifecycle.managed_entity import ManagedEntity
from rclpy.lifecycle.publisher import LifecyclePublisher
from rclpy.lifecycle.state_machine import STATES, TRANSITIONS, StateMachine, Transition, TransitionCallbackReturn
from rclpy.node import Node
from rclpy.qos import QoSProfile

_CALLBACKS = {
    "configure": "on_configure",
    "cleanup": "on_cleanup",
    "shutdown": "on_shutdown",
    "activate": "on_activate",
    "deactivate": "on_deactivate",
}


class LifecycleState(NamedTuple):
    """The state that a node is in before a transition."""

    label: str
    state_id: int


class LifecycleNodeMixin(ManagedEntity):
    """Mixin that makes a `Node` a managed one.

    Parameters
    ----------
    enable_communication_interface
        Whether other nodes may request transitions, and get events of them.
    callback_group
        Of the services; the node's default where None.
    """

    def __init__(
        self, *, enable_communication_interface: bool = True, callback_group: CallbackGroup | None = None
    ) -> None:
        self._state_machine = StateMachine()
        self._rcl_managed_entities: dict[ManagedEntity, None] = {}
        self._rcl_transition_event_publisher: Any = None
        self._callback_group = callback_group
        for transition_name, callback in _CALLBACKS.items():
            if not callable(getattr(self, callback)):
                raise TypeError(f"{callback} must be callable to {transition_name}")
        if not isinstance(enable_communication_interface, bool):
            raise TypeError("enable_communication_interface must be a bool")
        if enable_communication_interface:
            self._rcl_create_interface()

    def _rcl_create_interface(self) -> None:
        from lifecycle_msgs.msg import TransitionEvent
        from lifecycle_msgs.srv import ChangeState, GetAvailableStates, GetAvailableTransitions, GetState

        node: Any = self
        for kind, name, callback in (
            (ChangeState, "change_state", self._rcl_on_change_state),
            (GetState, "get_state", self._rcl_on_get_state),
            (GetAvailableStates, "get_available_states", self._rcl_on_get_available_states),
            (GetAvailableTransitions, "get_available_transitions", self._rcl_on_get_available_transitions),
            (GetAvailableTransitions, "get_transition_graph", self._rcl_on_get_transition_graph),
        ):
            service = node.create_service(kind, f"~/{name}", callback, callback_group=self._callback_group)
            setattr(self._state_machine, f"service_{name}", service)
        self._rcl_transition_event_publisher = node.create_publisher(
            TransitionEvent, "~/transition_event", QoSProfile(depth=10)
        )

    @property
    def current_state(self) -> LifecycleState:
        """The node's state."""
        return LifecycleState(self._state_machine.state.label, self._state_machine.state.state_id)

    def trigger_configure(self) -> TransitionCallbackReturn:
        """Change from unconfigured to inactive; raise RCLError when the state does not allow it."""
        return self._rcl_change_state(self._state_machine.by_label("configure"))

    def trigger_cleanup(self) -> TransitionCallbackReturn:
        """Change from inactive to unconfigured; raise RCLError when the state does not allow it."""
        return self._rcl_change_state(self._state_machine.by_label("cleanup"))

    def trigger_shutdown(self) -> TransitionCallbackReturn:
        """Change to finalized; raise RCLError when the state does not allow it."""
        return self._rcl_change_state(self._state_machine.by_label("shutdown"))

    def trigger_activate(self) -> TransitionCallbackReturn:
        """Change from inactive to active; raise RCLError when the state does not allow it."""
        return self._rcl_change_state(self._state_machine.by_label("activate"))

    def trigger_deactivate(self) -> TransitionCallbackReturn:
        """Change from active to inactive; raise RCLError when the state does not allow it."""
        return self._rcl_change_state(self._state_machine.by_label("deactivate"))

    def add_managed_entity(self, entity: ManagedEntity) -> None:
        """Add an entity that follows the node's transitions."""
        self._rcl_managed_entities[entity] = None

    # What a node does at transitions: by default, its managed entities do it.

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Prepare for activation: declare, create, allocate."""
        return self._rcl_all("on_configure", state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Release what `on_configure` created."""
        return self._rcl_all("on_cleanup", state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Shut down for good."""
        return self._rcl_all("on_shutdown", state)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Start working."""
        return self._rcl_all("on_activate", state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop working."""
        return self._rcl_all("on_deactivate", state)

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Recover from a transition that went wrong; SUCCESS leads to unconfigured, anything else to finalized."""
        return self._rcl_all("on_error", state)

    def _rcl_all(self, callback: str, state: LifecycleState) -> TransitionCallbackReturn:
        for entity in self._rcl_managed_entities:
            outcome = getattr(entity, callback)(state)
            if not isinstance(outcome, TransitionCallbackReturn):
                raise TypeError(f"{callback}() of {type(entity).__name__} returned {outcome!r}")
            if outcome != TransitionCallbackReturn.SUCCESS:
                return outcome
        return TransitionCallbackReturn.SUCCESS

    def create_lifecycle_publisher(self, *args: Any, **kwargs: Any) -> LifecyclePublisher:
        """Return a publisher that publishes while the node is active; see `Node.create_publisher`."""
        if "publisher_class" in kwargs:
            raise TypeError("create_publisher() got an unexpected keyword argument 'publisher_class'")
        node: Any = self
        publisher: LifecyclePublisher = node.create_publisher(*args, **kwargs, publisher_class=LifecyclePublisher)
        self._rcl_managed_entities[publisher] = None
        return publisher

    def destroy_lifecycle_publisher(self, publisher: LifecyclePublisher) -> bool:
        """Destroy such a publisher; False when it is not one of the node's."""
        self._rcl_managed_entities.pop(publisher, None)
        node: Any = self
        return bool(node.destroy_publisher(publisher))

    # Transitions.

    def _rcl_change_state(self, transition: Transition) -> TransitionCallbackReturn:
        before = LifecycleState(transition.start.label, transition.start.state_id)
        self._rcl_enter(transition)
        outcome = self._rcl_run(_CALLBACKS[transition.label], before)
        self._rcl_enter(self._state_machine.by_label(f"transition_{outcome.name.lower()}"))
        if outcome == TransitionCallbackReturn.ERROR:
            recovery = self._rcl_run("on_error", before)
            self._rcl_enter(self._state_machine.by_label(f"transition_{recovery.name.lower()}"))
        return outcome

    def _rcl_enter(self, transition: Transition) -> None:
        self._state_machine.state = transition.goal
        self._rcl_tell(transition)

    def _rcl_run(self, callback: str, state: LifecycleState) -> TransitionCallbackReturn:
        node: Any = self
        try:
            outcome = getattr(self, callback)(state)
        except UserError as error:
            node.get_logger().error(str(error))
            return TransitionCallbackReturn.FAILURE
        except Exception as error:
            node.get_logger().error(f"Error raised in {callback}: {error}")
            traceback.print_exc()
            return TransitionCallbackReturn.ERROR
        if isinstance(outcome, TransitionCallbackReturn):
            return outcome
        node.get_logger().error(f"{callback}() returned {outcome!r}, expected a TransitionCallbackReturn")
        return TransitionCallbackReturn.ERROR

    def _rcl_tell(self, transition: Transition) -> None:
        publisher = self._rcl_transition_event_publisher
        if publisher is None or publisher.handle.is_destroyed:
            return
        from lifecycle_msgs.msg import TransitionEvent

        node: Any = self
        description = _description(transition)
        publisher.publish(
            TransitionEvent(
                timestamp=node.get_clock().now().nanoseconds,
                transition=description.transition,
                start_state=description.start_state,
                goal_state=description.goal_state,
            )
        )

    # Services.

    def _rcl_on_change_state(self, request: Any, response: Any) -> Any:
        wanted = request.transition
        try:
            transition = (
                self._state_machine.by_label(wanted.label) if wanted.label else self._state_machine.by_id(wanted.id)
            )
        except RCLError as error:
            node: Any = self
            node.get_logger().warning(str(error))
            response.success = False
            return response
        response.success = self._rcl_change_state(transition) == TransitionCallbackReturn.SUCCESS
        return response

    def _rcl_on_get_state(self, request: Any, response: Any) -> Any:
        response.current_state.id = self._state_machine.state.state_id
        response.current_state.label = self._state_machine.state.label
        return response

    def _rcl_on_get_available_states(self, request: Any, response: Any) -> Any:
        response.available_states = [_state(state) for state in STATES]
        return response

    def _rcl_on_get_available_transitions(self, request: Any, response: Any) -> Any:
        response.available_transitions = [_description(transition) for transition in self._state_machine.available()]
        return response

    def _rcl_on_get_transition_graph(self, request: Any, response: Any) -> Any:
        response.available_transitions = [_description(transition) for transition in TRANSITIONS]
        return response


def _state(state: Any) -> Any:
    from lifecycle_msgs.msg import State

    return State(id=state.state_id, label=state.label)


def _description(transition: Transition) -> Any:
    from lifecycle_msgs.msg import Transition as TransitionMsg
    from lifecycle_msgs.msg import TransitionDescription

    return TransitionDescription(
        transition=TransitionMsg(id=transition.transition_id, label=transition.label),
        start_state=_state(transition.start),
        goal_state=_state(transition.goal),
    )


class LifecycleNode(LifecycleNodeMixin, Node):
    """A managed node; the other arguments are those of `Node`."""

    def __init__(self, node_name: str, *, enable_communication_interface: bool = True, **kwargs: Any) -> None:
        Node.__init__(self, node_name, **kwargs)
        LifecycleNodeMixin.__init__(self, enable_communication_interface=enable_communication_interface)

    def destroy_node(self) -> None:
        """Destroy the node."""
        self._rcl_transition_event_publisher = None
        Node.destroy_node(self)

"""The life cycle of a node, from the side of the launch."""

from __future__ import annotations

import functools
import threading
from typing import TYPE_CHECKING, Any

import launch.logging
from launch import EventHandler

from ..events.lifecycle import ChangeState, StateTransition
from ..ros_adapters import get_ros_node, run_with_ros_node

if TYPE_CHECKING:
    from launch import Action, LaunchContext


class LifecycleEventManager:
    """Manager that emits the state transitions of a node as events of the launch, and passes its events to the node.

    Parameters
    ----------
    lifecycle_node
        The action that runs the node; must have `node_name`.
    """

    def __init__(self, lifecycle_node: Any) -> None:
        self.__action = lifecycle_node
        self.__logger = launch.logging.get_logger(__name__)
        self.__subscription: Any = None
        self.__client: Any = None

    @property
    def node_name(self) -> str:
        """The node's full name."""
        name: str = self.__action.node_name
        return name

    def setup_lifecycle_manager(self, context: LaunchContext) -> None:
        """Listen to the node and to the launch."""
        import lifecycle_msgs.msg
        import lifecycle_msgs.srv

        node = get_ros_node(context)
        self.__subscription = node.create_subscription(
            lifecycle_msgs.msg.TransitionEvent,
            f"{self.node_name}/transition_event",
            functools.partial(self._on_transition_event, context),
            10,
        )
        self.__client = node.create_client(lifecycle_msgs.srv.ChangeState, f"{self.node_name}/change_state")
        context.register_event_handler(
            EventHandler(matcher=lambda event: isinstance(event, ChangeState), entities=[_on(self)])
        )

    def _on_transition_event(self, context: LaunchContext, msg: Any) -> None:
        try:
            context.emit_event_sync(StateTransition(action=self.__action, msg=msg))
        except RuntimeError as error:
            self.__logger.error(f"Exception in handling of 'lifecycle.StateTransition': {error}")

    def on_change_state_event(self, context: LaunchContext, event: ChangeState) -> None:
        """Request a transition of the node, if the event is for it."""
        if not event.lifecycle_node_matcher(self.__action):
            return
        import lifecycle_msgs.srv

        request = lifecycle_msgs.srv.ChangeState.Request()
        request.transition.id = event.transition_id
        context.add_completion_future(run_with_ros_node(context, self.__call, context, request, event))

    def __call(self, context: LaunchContext, request: Any, event: ChangeState) -> None:
        service = f"{self.node_name}/change_state"
        while not self.__client.wait_for_service(timeout_sec=1.0):
            if context.is_shutdown:
                self.__logger.warning(f"Abandoning wait for the '{service}' service, due to shutdown.")
                return
        done = threading.Event()
        response = self.__client.call_async(request)
        response.add_done_callback(lambda _: done.set())
        while not done.wait(1.0):
            if context.is_shutdown:
                self.__logger.debug(f"Abandoning wait for the '{service}' response, due to shutdown.")
                response.cancel()
                return
        if response.exception() is not None:
            raise response.exception()
        if not response.result().success:
            self.__logger.error(
                f"Failed to make transition '{event.transition_id}' for LifecycleNode '{self.node_name}'"
            )


def _on(manager: LifecycleEventManager) -> Action:
    from launch.actions import OpaqueFunction

    return OpaqueFunction(function=lambda context: manager.on_change_state_event(context, context.locals.event))

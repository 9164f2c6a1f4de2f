"""Managed nodes that undo what they configured, and whose actions are served while they are active."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any

from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.exceptions import ParameterException
from rclpy.lifecycle import LifecycleNode, LifecycleState, ManagedEntity, TransitionCallbackReturn

from daidalos.common.errors import UserError
from daidalos.navigation.errors import NavigationError
from daidalos.nodes.action_results import set_error
from daidalos.nodes.node_thread import NodeThread
from daidalos.nodes.parameters import warn_of_undeclared

_MEMBERS = ("publisher", "subscription", "service", "client")


class ManagedNode(LifecycleNode):
    """A managed node whose entities last from its configuration to its clean-up.

    A subclass creates them in `configure`. They are destroyed on clean-up, on shutdown and when the configuration
    fails, so that the node can be configured again. Its managed entities, such as a `ContainedNode`, go through each
    transition first.
    """

    def __init__(self, node_name: str, **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._lasting: set[Any] = set()
        self._goals: dict[Any, Any] = {}

    @property
    def is_active(self) -> bool:
        """Whether the node is active, or about to be."""
        return self.current_state.label in ("activating", "active")

    def configure(self) -> None:
        """Create what the node needs while it is inactive or active.

        Raises
        ------
        UserError, ParameterException
            The parameters cannot be followed. The transition fails, with the error's message in the log.
        """

    def serve_action(
        self,
        action: Any,
        name: str,
        execute: Callable[[Any], Awaitable[Any]],
        refusal: Callable[[Any], str] = lambda request: "",
    ) -> None:
        """Serve an action whose goals are rejected while the node is not active, and aborted when it is deactivated.

        Parameters
        ----------
        action
            Class of the action.
        name
            Its name.
        execute
            Carries out a goal, given its handle, and returns the result. A `NavigationError` aborts the goal. It has
            to return soon after the goal is no longer active.
        refusal
            Returns why a goal is rejected, an empty string where it is accepted.
        """

        def on_goal(request: Any) -> GoalResponse:
            reason = refusal(request) if self.is_active else f"{self.get_name()} is not active"
            if reason:
                self.get_logger().warning(f"a goal of '{name}' was rejected: {reason}")
            return GoalResponse.REJECT if reason else GoalResponse.ACCEPT

        async def carry_out(goal_handle: Any) -> Any:
            self._goals[goal_handle] = action
            try:
                if not self.is_active:
                    raise NavigationError(f"{self.get_name()} is not active")
                return await execute(goal_handle)
            except NavigationError as error:
                result = set_error(action.Result(), error)
                if goal_handle.is_active:
                    self.get_logger().warning(f"{name} failed: {error}")
                    goal_handle.abort(result)
                return result
            finally:
                del self._goals[goal_handle]

        ActionServer(
            self, action, name, carry_out, goal_callback=on_goal, cancel_callback=lambda goal: CancelResponse.ACCEPT
        )

    def _abort_goals(self) -> None:
        for goal, action in list(self._goals.items()):
            if goal.is_active:
                goal.abort(set_error(action.Result(), NavigationError(f"{self.get_name()} was deactivated")))

    # Transitions.

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Configure the managed entities, then the node itself; undo both if either fails."""
        self._lasting = set(self._members())
        outcome = super().on_configure(state)
        if outcome == TransitionCallbackReturn.SUCCESS:
            try:
                self.configure()
                warn_of_undeclared(self)
            except (UserError, ParameterException) as error:
                self.get_logger().error(f"cannot configure {self.get_name()}: {error}")
                outcome = TransitionCallbackReturn.FAILURE
        if outcome != TransitionCallbackReturn.SUCCESS:
            self.on_cleanup(state)
        return outcome

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Abort the goals that are being carried out."""
        self._abort_goals()
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Destroy what `configure` created."""
        for kind in _MEMBERS:
            for member in set(getattr(self, f"{kind}s")) - self._lasting:
                getattr(self, f"destroy_{kind}")(member)
        for waitable in set(self.waitables) - self._lasting:
            waitable.destroy()  # type: ignore[attr-defined]
        return super().on_cleanup(state)

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Deactivate and clean up as far as that is left to do."""
        if state.label == "active":
            self.on_deactivate(state)
        if state.label in ("active", "inactive"):
            self.on_cleanup(state)
        return super().on_shutdown(state)

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Destroy what was created, so that the node can be configured again."""
        self.on_cleanup(state)
        return super().on_error(state)

    def destroy_node(self) -> None:
        """Deactivate the node if it is active, as Nav2's nodes do before they end, and destroy it."""
        if self.current_state.label == "active":
            self.trigger_deactivate()
        super().destroy_node()

    def _members(self) -> list[Any]:
        return [*self.waitables, *(member for kind in _MEMBERS for member in getattr(self, f"{kind}s"))]


class ContainedNode(NodeThread, ManagedEntity):
    """A managed node that another one contains: it has a thread of its own and its owner's transitions.

    The transitions of the owner, which passes it to `LifecycleNode.add_managed_entity`, fail where those of the node
    do.
    """

    def __init__(self, node: LifecycleNode) -> None:
        super().__init__(node)
        self._node = node

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Configure the node."""
        return self._node.trigger_configure()

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Activate the node."""
        return self._node.trigger_activate()

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Deactivate the node, unless that was done on its own."""
        return self._node.trigger_deactivate() if self._is("active") else TransitionCallbackReturn.SUCCESS

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Clean the node up as far as that is left to do."""
        self.on_deactivate(state)
        return self._node.trigger_cleanup() if self._is("inactive") else TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Shut the node down, unless that was done on its own."""
        return TransitionCallbackReturn.SUCCESS if self._is("finalized") else self._node.trigger_shutdown()

    def _is(self, label: str) -> bool:
        return self._node.current_state.label == label

    def destroy(self) -> None:
        """End the thread and destroy the node."""
        self.stop()
        self._node.destroy_node()

"""A goal as its sender sees it."""

from __future__ import annotations

from types import GenericAlias
from typing import TYPE_CHECKING, Any, ClassVar

from rclpy.task import Future

if TYPE_CHECKING:
    from rclpy.action.client import ActionClient


class ClientGoalHandle:
    """A goal that was sent, as its sender sees it."""

    __class_getitem__: ClassVar[Any] = classmethod(GenericAlias)

    def __init__(self, action_client: ActionClient, goal_id: Any, goal_response: Any) -> None:
        self._action_client = action_client
        self._goal_id = goal_id
        self._goal_response = goal_response
        self._status = 0

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ClientGoalHandle) and self._goal_id == other.goal_id

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return (
            f"ClientGoalHandle <id={bytes(self._goal_id.uuid).hex()}, accepted={self.accepted}, status={self.status}>"
        )

    @property
    def goal_id(self) -> Any:
        """The goal's identity, a ``unique_identifier_msgs/msg/UUID``."""
        return self._goal_id

    @property
    def stamp(self) -> Any:
        """When the server accepted the goal."""
        return self._goal_response.stamp

    @property
    def accepted(self) -> bool:
        """Whether the server accepted the goal."""
        return bool(self._goal_response.accepted)

    @property
    def status(self) -> int:
        """The goal's state, as in ``action_msgs/msg/GoalStatus``."""
        return self._status

    def cancel_goal(self) -> Any:
        """Request cancellation and wait for the ``CancelGoal`` response."""
        return self._action_client._cancel_goal(self)

    def cancel_goal_async(self) -> Future:
        """Request cancellation; the future's result will be the ``CancelGoal`` response."""
        return self._action_client._cancel_goal_async(self)

    def get_result(self) -> Any:
        """Wait for the result: an object with ``status`` and ``result``."""
        return self._action_client._get_result(self)

    def get_result_async(self) -> Future:
        """Request the result; the future's result will be an object with ``status`` and ``result``."""
        return self._action_client._get_result_async(self)

"""The server of interactive markers: it publishes them to clients such as RViz and receives their feedback."""

from __future__ import annotations

import copy
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from builtin_interfaces.msg import Time
from rclpy.qos import QoSProfile
from std_msgs.msg import Header
from visualization_msgs.msg import (
    InteractiveMarker,
    InteractiveMarkerFeedback,
    InteractiveMarkerPose,
    InteractiveMarkerUpdate,
)
from visualization_msgs.srv import GetInteractiveMarkers

if TYPE_CHECKING:
    from geometry_msgs.msg import Pose
    from rclpy.node import Node
    from rclpy.time import Time as RosTime

FeedbackCallback = Callable[[InteractiveMarkerFeedback], Any]

_HOLD = 1.0
"""For how long [s] after feedback of one client that of others is ignored."""


@dataclass
class MarkerContext:
    """A marker that was published, and its callbacks for feedback."""

    int_marker: InteractiveMarker
    last_feedback: RosTime | None = None
    last_client_id: str = ""
    default_feedback_callback: FeedbackCallback | None = None
    feedback_callbacks: dict[int, FeedbackCallback] = field(default_factory=dict)

    def callback_for(self, event_type: int) -> FeedbackCallback | None:
        """Return the callback for an event."""
        return self.feedback_callbacks.get(event_type, self.default_feedback_callback)


@dataclass
class UpdateContext:
    """A change that was not published yet."""

    FULL_UPDATE = 0
    POSE_UPDATE = 1
    ERASE = 2

    update_type: int
    int_marker: InteractiveMarker | None = None
    default_feedback_callback: FeedbackCallback | None = None
    feedback_callbacks: dict[int, FeedbackCallback] = field(default_factory=dict)


class InteractiveMarkerServer:
    """Server that displays a set of interactive markers to one or many clients, such as RViz.

    Changes made by `insert`, `erase` and so on reach the clients with `applyChanges`. All methods may be called from
    any thread.

    Parameters
    ----------
    node
        Publishes ``<namespace>/update``, listens to ``<namespace>/feedback`` and serves
        ``<namespace>/get_interactive_markers``.
    namespace
        Of these three names.
    update_pub_qos, feedback_sub_qos
        How the two topics are published and listened to.
    """

    DEFAULT_FEEDBACK_CALLBACK = 255

    def __init__(
        self,
        node: Node,
        namespace: str,
        *,
        update_pub_qos: QoSProfile | None = None,
        feedback_sub_qos: QoSProfile | None = None,
    ) -> None:
        self.node = node
        self.topic_namespace = namespace
        self.marker_contexts: dict[str, MarkerContext] = {}
        self.pending_updates: dict[str, UpdateContext] = {}
        self.sequence_number = 0
        self.mutex = threading.RLock()
        self.server_id = f"{node.get_fully_qualified_name()}/{namespace}"
        self._is_shut_down = False
        self.get_interactive_markers_srv = node.create_service(
            GetInteractiveMarkers, f"{namespace}/get_interactive_markers", self.getInteractiveMarkersCallback
        )
        self.update_pub = node.create_publisher(
            InteractiveMarkerUpdate, f"{namespace}/update", update_pub_qos or QoSProfile(depth=100)
        )
        self.feedback_sub = node.create_subscription(
            InteractiveMarkerFeedback,
            f"{namespace}/feedback",
            self.processFeedback,
            feedback_sub_qos or QoSProfile(depth=1),
        )

    def shutdown(self) -> None:
        """Erase all markers and end what the server has in the graph; a second call does nothing."""
        with self.mutex:
            if self._is_shut_down:
                return
            self._is_shut_down = True
            self.clear()
            self.applyChanges()
        self.node.destroy_service(self.get_interactive_markers_srv)
        self.node.destroy_publisher(self.update_pub)
        self.node.destroy_subscription(self.feedback_sub)

    def insert(
        self,
        marker: InteractiveMarker,
        *,
        feedback_callback: FeedbackCallback | None = None,
        feedback_type: int = DEFAULT_FEEDBACK_CALLBACK,
    ) -> None:
        """Add a marker, or replace the one of its name.

        The change takes effect with `applyChanges`, the callback at once.

        Parameters
        ----------
        marker
            The marker; later changes to this object are not seen.
        feedback_callback
            Called with an `InteractiveMarkerFeedback` when somebody does something with the marker.
        feedback_type
            Of which events, such as `InteractiveMarkerFeedback.MOUSE_UP`; of all that have no callback of their own
            if not said.
        """
        with self.mutex:
            update = self.pending_updates.setdefault(marker.name, UpdateContext(UpdateContext.FULL_UPDATE))
            update.update_type = UpdateContext.FULL_UPDATE
            update.int_marker = copy.deepcopy(marker)
        if feedback_callback is not None:
            self.setCallback(marker.name, feedback_callback, feedback_type)

    def setPose(self, name: str, pose: Pose, header: Header | None = None) -> bool:
        """Move a marker, with `applyChanges`; return whether there is one of this name.

        Parameters
        ----------
        name
            Of the marker.
        pose
            Where to.
        header
            The frame of the pose; the marker's own if it has no name.
        """
        header = header or Header()
        with self.mutex:
            marker = self._current(name)
            if marker is None:
                return False
            self.doSetPose(self.pending_updates.get(name), name, pose, header if header.frame_id else marker.header)
            return True

    def erase(self, name: str) -> bool:
        """Remove a marker, with `applyChanges`; return whether there is one of this name."""
        with self.mutex:
            if name in self.marker_contexts:
                self.pending_updates[name] = UpdateContext(UpdateContext.ERASE)
                return True
            return self.pending_updates.pop(name, None) is not None

    def clear(self) -> None:
        """Remove all markers, with `applyChanges`."""
        with self.mutex:
            self.pending_updates = {name: UpdateContext(UpdateContext.ERASE) for name in self.marker_contexts}

    def setCallback(
        self,
        name: str,
        feedback_callback: FeedbackCallback | None,
        feedback_type: int = DEFAULT_FEEDBACK_CALLBACK,
    ) -> bool:
        """Set the callback for feedback about a marker, at once; return whether there is one of this name.

        Parameters
        ----------
        name
            Of the marker.
        feedback_callback
            See `insert`; None for nobody any more.
        feedback_type
            See `insert`.
        """
        with self.mutex:
            holders = [holder for holder in (self.marker_contexts.get(name), self._insertion(name)) if holder]
            for holder in holders:
                if feedback_type == self.DEFAULT_FEEDBACK_CALLBACK:
                    holder.default_feedback_callback = feedback_callback
                elif feedback_callback is None:
                    holder.feedback_callbacks.pop(feedback_type, None)
                else:
                    holder.feedback_callbacks[feedback_type] = feedback_callback
            return bool(holders)

    def applyChanges(self) -> None:
        """Apply the changes since the last call, and publish them to the clients."""
        with self.mutex:
            if not self.pending_updates:
                return
            message = InteractiveMarkerUpdate(type=InteractiveMarkerUpdate.UPDATE)
            pending, self.pending_updates = self.pending_updates, {}
            for name, update in pending.items():
                self._apply(name, update, message)
            self.sequence_number += 1
            self.publish(message)

    def _apply(self, name: str, update: UpdateContext, message: InteractiveMarkerUpdate) -> None:
        """Apply one change, and add it to the update for the clients."""
        if update.update_type == UpdateContext.ERASE:
            del self.marker_contexts[name]
            message.erases.append(name)
            return
        marker = update.int_marker
        assert marker is not None
        context = self.marker_contexts.get(name)
        if context is None:
            context = self.marker_contexts[name] = MarkerContext(
                marker,
                default_feedback_callback=update.default_feedback_callback,
                feedback_callbacks=update.feedback_callbacks,
            )
        context.int_marker = marker
        if update.update_type == UpdateContext.FULL_UPDATE:
            message.markers.append(marker)
        else:
            message.poses.append(InteractiveMarkerPose(header=marker.header, pose=marker.pose, name=name))

    def get(self, name: str) -> InteractiveMarker | None:
        """Return a copy of a marker with its changes so far; None where there is none of this name."""
        with self.mutex:
            return copy.deepcopy(self._current(name))

    def getNames(self) -> list[str]:
        """Return the names of the markers that clients know of."""
        with self.mutex:
            return list(self.marker_contexts)

    def processFeedback(self, feedback: InteractiveMarkerFeedback) -> None:
        """Process feedback about a marker, and pass it to the callbacks.

        While one client moves a marker, others are ignored: until a second after its last feedback.
        """
        with self.mutex:
            context = self.marker_contexts.get(feedback.marker_name)
            if context is None:
                return
            now = self.node.get_clock().now()
            if (
                context.last_feedback is not None
                and context.last_client_id != feedback.client_id
                and (now - context.last_feedback).nanoseconds < _HOLD * 1e9
            ):
                self.node.get_logger().debug(
                    f"Rejecting feedback for '{feedback.marker_name}': conflicting feedback from separate clients"
                )
                return
            context.last_feedback, context.last_client_id = now, feedback.client_id
            if feedback.event_type == InteractiveMarkerFeedback.POSE_UPDATE:
                # A marker without a stamp stays in its frame, whatever happens to that.
                stays = context.int_marker.header.stamp == Time()
                self.doSetPose(
                    self.pending_updates.get(feedback.marker_name),
                    feedback.marker_name,
                    feedback.pose,
                    context.int_marker.header if stays else feedback.header,
                )
            callback = context.callback_for(feedback.event_type)
        if callback is not None:
            callback(feedback)

    def getInteractiveMarkersCallback(self, request: Any, response: Any) -> Any:
        """Return all markers to a client."""
        with self.mutex:
            response.sequence_number = self.sequence_number
            response.markers = [copy.deepcopy(context.int_marker) for context in self.marker_contexts.values()]
        return response

    def publish(self, update: InteractiveMarkerUpdate) -> None:
        """Publish changes to the clients."""
        update.server_id = self.server_id
        update.seq_num = self.sequence_number
        self.update_pub.publish(update)

    def doSetPose(self, update: UpdateContext | None, name: str, pose: Pose, header: Header) -> None:
        """Schedule a new pose of a marker; the caller holds the mutex.

        Parameters
        ----------
        update
            The marker's change so far, None if there is none; a marker that is being erased stays so.
        name, pose, header
            See `setPose`.
        """
        if update is None:
            moved = copy.deepcopy(self.marker_contexts[name].int_marker)
            update = self.pending_updates[name] = UpdateContext(UpdateContext.POSE_UPDATE, moved)
        if update.int_marker is not None:
            update.int_marker.pose = copy.deepcopy(pose)
            update.int_marker.header = copy.deepcopy(header)

    def _current(self, name: str) -> InteractiveMarker | None:
        """Return a marker with its changes so far."""
        if name in self.pending_updates:
            return self.pending_updates[name].int_marker
        context = self.marker_contexts.get(name)
        return None if context is None else context.int_marker

    def _insertion(self, name: str) -> UpdateContext | None:
        """Return the change that adds a marker which clients do not know of yet."""
        return None if name in self.marker_contexts else self.pending_updates.get(name)

"""Common base of `mux` and `demux`: a list of topics, one of which is selected."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rclpy.node import Node

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.parameters import declare
from daidalos.nodes.qos import LATCHED

NONE = "__none"
"""Chooses no topic."""


@dataclass(frozen=True)
class SwitchParameters(Parameters):
    """Common parameters of ``mux`` and ``demux``."""

    initial_topic: str = parameter("", "Topic selected at first, ``__none`` for none; the first one where empty.")
    lazy: bool = parameter(False, "Whether to subscribe only while an output has subscribers.")

    @property
    def choice(self) -> tuple[str, ...]:
        """Topics of which one is selected."""
        raise NotImplementedError


class Switch(Node):
    """Server of ``~/add``, ``~/delete``, ``~/list`` and ``~/select`` that publishes ``~/selected``.

    Parameters
    ----------
    name
        The node's.
    parameters
        The class of the node's parameters.
    kinds
        The classes of the services: add, delete, list, select.
    """

    def __init__(
        self, name: str, parameters: type[SwitchParameters], kinds: tuple[Any, Any, Any, Any], **kwargs: Any
    ) -> None:
        super().__init__(name, **kwargs)
        from std_msgs.msg import String

        self.settings: Any = declare(self, parameters)
        self.topics = [topic for topic in self.settings.choice if topic]
        self.chosen = self.settings.initial_topic or (self.topics[0] if self.topics else NONE)
        if self.chosen != NONE and self.chosen not in self.topics:
            raise RuntimeError(f"initial_topic '{self.chosen}' is not one of {', '.join(self.topics) or 'no topics'}")
        self._selected = self.create_publisher(String, "~/selected", LATCHED)
        handlers: tuple[Callable[[Any, Any], Any], ...] = (
            self._on_add,
            self._on_delete,
            self._on_list,
            self._on_select,
        )
        for verb, kind, handler in zip(("add", "delete", "list", "select"), kinds, handlers, strict=True):
            self.create_service(kind, f"~/{verb}", handler)

    def choose(self, topic: str) -> None:
        """Make a choice known."""
        from std_msgs.msg import String

        self.chosen = topic
        self._selected.publish(String(data=topic))

    def added(self, topic: str) -> None:
        """Do what is to be done for a new topic."""

    def removed(self, topic: str) -> None:
        """Do what is to be done for a topic that is no more."""

    def _on_add(self, request: Any, response: Any) -> Any:
        response.success = bool(request.topic) and request.topic != NONE and request.topic not in self.topics
        if response.success:
            self.topics.append(request.topic)
            self.added(request.topic)
            self.get_logger().info(f"added {request.topic}")
        else:
            self.get_logger().warning(f"tried to add a topic that is there already, or cannot be: [{request.topic}]")
        return response

    def _on_delete(self, request: Any, response: Any) -> Any:
        response.success = request.topic in self.topics and request.topic != self.chosen
        if response.success:
            self.topics.remove(request.topic)
            self.removed(request.topic)
            self.get_logger().info(f"deleted {request.topic}")
        else:
            self.get_logger().warning(f"tried to delete a topic that is chosen or not there: [{request.topic}]")
        return response

    def _on_list(self, request: Any, response: Any) -> Any:
        response.topics = self.topics
        return response

    def _on_select(self, request: Any, response: Any) -> Any:
        response.prev_topic = self.chosen
        response.success = request.topic == NONE or request.topic in self.topics
        if response.success:
            self.choose(request.topic)
            self.get_logger().info(f"selected {request.topic}")
        else:
            self.get_logger().warning(f"tried to select a topic that is not there: [{request.topic}]")
        return response

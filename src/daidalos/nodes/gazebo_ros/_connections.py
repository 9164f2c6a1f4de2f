"""The topics and services that a simulation's sensors and plugins ask for, on a node."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from rclpy.node import Node

from daidalos.nodes.gazebo_ros._pacing import PacedSimulation
from daidalos.nodes.gazebo_ros._pictures import PictureBudget
from daidalos.nodes.warming import warm_up_in_background

if TYPE_CHECKING:
    from collections.abc import Iterator

    from daidalos.samples.sensors import Sample
    from daidalos.simulation import Simulation


class Connections:
    """Publishers for what a simulation's sensors measure, subscriptions and services for what its plugins obey.

    Parameters
    ----------
    node : Node
        On which they are.

    Attributes
    ----------
    paced : PacedSimulation
        Called with the commands; to be set before `follow`.
    """

    paced: PacedSimulation

    def __init__(self, node: Node) -> None:
        self._node = node
        self._outgoing: dict[str, tuple[Any, Any]] = {}
        self._incoming: dict[str, Any] = {}
        self._offered: dict[str, Any] = {}
        self._warned: set[str] = set()
        self._drawn: set[str] = set()
        self._renderer_ready: threading.Event | None = None
        self._pictures = PictureBudget(lambda: self.paced.lag_ns)

    def warn_once(self, text: str) -> None:
        """Log a warning unless it was logged before."""
        if text not in self._warned:
            self._warned.add(text)
            self._node.get_logger().warning(text)

    def has_subscribers(self, topic: str) -> bool:
        """Return whether anybody subscribes to a topic of the simulation, and it can be served.

        Pictures can be once the renderer is ready, which it becomes in the background while the world runs by the
        clock of the wall; otherwise the world waits for it.
        """
        entry = self._outgoing.get(topic)
        heard = entry is not None and entry[0].handle.has_subscribers
        return heard and (topic not in self._drawn or self._can_draw())

    def _can_draw(self) -> bool:
        if self._renderer_ready is None:
            self._renderer_ready = ready = threading.Event()
            compiled = warm_up_in_background("daidalos.simulation.rendering", self._node.get_logger())
            compiled.add_done_callback(lambda _: ready.set())
        if self.paced.paused or self.paced.real_time_factor <= 0.0:
            self._renderer_ready.wait()
        return self._renderer_ready.is_set()

    def has_time_to_draw(self, topic: str, now_ns: int) -> bool:
        """Return whether a camera's picture is drawn; some are dropped while the world is late."""
        allowed = self._pictures.allows(topic, now_ns)
        if not allowed:
            self.warn_once("cameras cannot keep up with the wanted speed; pictures are dropped")
        return allowed

    def publish(self, samples: list[Sample]) -> None:
        """Publish what is listened to; transforms of the same step go into one message."""
        transforms = []
        for sample in samples:
            if not self.has_subscribers(sample.topic):
                continue
            if sample.topic == "/tf":
                transforms.append(sample)
            else:
                publisher, convert = self._outgoing[sample.topic]
                publisher.publish(convert(sample))
        if transforms:
            self._publish_transforms(transforms)

    def _publish_transforms(self, transforms: list[Any]) -> None:
        from tf2_msgs.msg import TFMessage

        from daidalos.samples.messages import TRANSFORM

        self._outgoing["/tf"][0].publish(TFMessage(transforms=[TRANSFORM.to_message(one) for one in transforms]))

    def follow(self, simulation: Simulation) -> None:
        """Make a publisher or subscription for every topic of the simulation, and remove those it lost."""
        from daidalos.samples.messages import MESSAGES, conversion_of

        wanted = simulation.publications
        for topic in [topic for topic in self._outgoing if topic not in wanted]:
            self._node.destroy_publisher(self._outgoing.pop(topic)[0])
        for topic, kind in wanted.items():
            conversion = conversion_of(kind)
            if conversion is None:
                self.warn_once(f"{topic} is not published: no message is known for {kind.__name__}")
            elif topic not in self._outgoing:
                self._outgoing[topic] = (
                    self._node.create_publisher(conversion.message_class, topic, 10),
                    conversion.to_message,
                )
                self._node.get_logger().debug(f"publishes {topic}")
        commands = simulation.subscriptions
        for topic in [topic for topic in self._incoming if topic not in commands]:
            self._node.destroy_subscription(self._incoming.pop(topic))
        for topic, command in commands.items():
            accepted = MESSAGES.get(command)
            if accepted is None:
                self.warn_once(f"{topic} is not listened to: no message is known for {command.__name__}")
            elif topic not in self._incoming:
                take = self._taker(topic, accepted.from_message)
                self._incoming[topic] = self._node.create_subscription(accepted.message_class, topic, take, 10)
                self._node.get_logger().debug(f"listens to {topic}")

        self._drawn = set(_pictures(simulation))
        self._connect_switches(simulation)

    def _connect_switches(self, simulation: Simulation) -> None:
        """Offer the services of plugins."""
        from std_srvs.srv import Empty, SetBool

        wanted = simulation.switches
        for name in [name for name in self._offered if name not in wanted]:
            self._node.destroy_service(self._offered.pop(name))
        for name, switch in wanted.items():
            if name not in self._offered:
                kind = SetBool if switch.fixed is None else Empty
                self._offered[name] = self._node.create_service(kind, name, self._switcher(name))

    def _switcher(self, name: str) -> Callable[[Any, Any], Any]:
        def answer(request: Any, response: Any) -> Any:
            def work(simulation: Simulation) -> None:
                switch = simulation.switches[name]
                switch.take(bool(request.data) if switch.fixed is None else switch.fixed)

            self.paced.call(work)
            if hasattr(response, "success"):
                response.success = True
            return response

        return answer

    def _taker(self, topic: str, convert: Callable[[Any], Any]) -> Callable[[Any], None]:
        def take(message: Any) -> None:
            command = convert(message)
            self.paced.post(lambda: self.paced.simulation.command(topic, command))

        return take


def _pictures(simulation: Simulation) -> Iterator[str]:
    """Yield the topics for which cameras draw."""
    from daidalos.simulation.sensors.camera import Camera

    for camera in simulation.components:
        if isinstance(camera, Camera):
            for output in camera.outputs:
                yield from (topic for topic in output.topics() if topic not in output.infos)

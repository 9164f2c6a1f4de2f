"""`turtlesim_node`: simulator of turtles; its window is a page of the studio."""

from __future__ import annotations

import argparse
import math
import random
from dataclasses import dataclass
from typing import Any

from rclpy.event_handler import PublisherEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSProfile

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import program_arguments, run
from daidalos.nodes.studio_window import run_with_window
from daidalos.nodes.turtlesim._drawing import Drawing
from daidalos.nodes.turtlesim._turtle import SIZE, UPDATE_S, Turtle
from daidalos.nodes.turtlesim._turtle_interface import TurtleInterface

_KINDS = 8  # drawings of turtles that the window has
_STILL_UPDATES = 12  # a window in which nothing moves is told so this seldom


def _channel(default: int, name: str) -> Any:
    return parameter(default, f"{name} channel of the background color", minimum=0, maximum=255)


@dataclass(frozen=True)
class TurtleSimParameters(Parameters):
    """Parameters of ``turtlesim_node``, with the descriptions that ROS 2 shows."""

    background_r: int = _channel(69, "Red")
    background_g: int = _channel(86, "Green")
    background_b: int = _channel(255, "Blue")
    holonomic: bool = parameter(False, "If true, then turtle will be a holonomic robot")


class TurtleSim(Node):
    """Simulator of turtles.

    Services: ``clear``, ``reset``, ``spawn``, ``kill``; for those of each turtle see
    `TurtleInterface`. The hidden topic ``~/_window`` and the hidden service ``~/_drawing`` are for the page.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("turtlesim", **kwargs)
        from daidalos_msgs.msg import TurtleWindow
        from daidalos_msgs.srv import GetTurtleDrawing
        from rcl_interfaces.msg import ParameterEvent
        from std_srvs.srv import Empty
        from turtlesim.srv import Kill, Spawn

        self.settings = declare(self, TurtleSimParameters, reconfigure=self._reconfigure)
        self._read_background()
        self.create_subscription(ParameterEvent, "/parameter_events", self._on_parameters, 10)
        self._turtles: dict[str, TurtleInterface] = {}
        self._drawing = Drawing()
        self._named = 0
        self._shown: tuple[Any, ...] = ()
        self._still = 0
        self.create_service(Empty, "clear", self._on_clear)
        self.create_service(Empty, "reset", self._on_reset)
        self.create_service(Spawn, "spawn", self._on_spawn)
        self.create_service(Kill, "kill", self._on_kill)
        self._resting_until: int | None = None
        self._window = self.create_publisher(
            TurtleWindow, "~/_window", QoSProfile(depth=20), event_callbacks=self.waking_events
        )
        self.create_service(GetTurtleDrawing, "~/_drawing", self._on_drawing)
        self.get_logger().info(f"Starting turtlesim with node name {self.get_fully_qualified_name()}")
        self._timer = self.create_timer(UPDATE_S, self._update)
        self._spawn("", SIZE / 2, SIZE / 2, 0.0)

    @property
    def waking_events(self) -> PublisherEventCallbacks:
        """Events of a publisher whose subscriptions end the rest."""
        return PublisherEventCallbacks(matched=lambda status: self.wake())

    @property
    def window_topic(self) -> str:
        """Topic that the page subscribes to."""
        return str(self._window.topic_name)

    def _update(self) -> None:
        now_s = self.get_clock().now().nanoseconds * 1e-9
        rests = not self._window.handle.has_subscribers
        for interface in self._turtles.values():
            turtle = interface.turtle
            before, is_turning = (turtle.x, turtle.y), interface.turn()
            hit = turtle.step(now_s)
            if hit is not None:
                self.get_logger().warning(f"Oh no! I hit the wall! (Clamping from [x={hit[0]:f}, y={hit[1]:f}])")
            is_heard = interface.publish(self._colour_below)
            self._draw(turtle, before)
            rests = rests and turtle.is_still and before == (turtle.x, turtle.y) and not (is_heard or is_turning)
        self._show()
        if rests:
            self._rest()

    def _rest(self) -> None:
        """Make no updates while nothing moves and nobody looks."""
        left = self._timer.time_until_next_call()
        if left is not None:
            self._resting_until = self.get_clock().now().nanoseconds + left
            self._timer.cancel()

    def wake(self) -> None:
        """Make updates again, at the times at which they would have been."""
        if self._resting_until is None:
            return
        due, self._resting_until = self._resting_until, None
        period = self._timer.timer_period_ns
        self._timer.timer_period_ns = (due - self.get_clock().now().nanoseconds) % period or period
        self._timer.reset()
        self._timer.timer_period_ns = period

    def _colour_below(self, turtle: Turtle) -> tuple[int, int, int]:
        return self._drawing.colour_at(turtle.x, turtle.y) or self._background

    def _draw(self, turtle: Turtle, before: tuple[float, float]) -> None:
        """Draw what a turtle's pen left behind on its way."""
        if turtle.pen.is_down and (turtle.x, turtle.y) != before:
            self._drawing.draw(before, (turtle.x, turtle.y), turtle.pen)

    def _reconfigure(self, parameters: TurtleSimParameters) -> None:
        self.settings = parameters

    def _on_parameters(self, event: Any) -> None:
        if event.node == self.get_fully_qualified_name():
            self._read_background()

    def _read_background(self) -> None:
        self._background = (self.settings.background_r, self.settings.background_g, self.settings.background_b)

    # Services.

    def _on_clear(self, request: Any, response: Any) -> Any:
        self.get_logger().info("Clearing turtlesim.")
        self._drawing.clear()
        return response

    def _on_reset(self, request: Any, response: Any) -> Any:
        self.get_logger().info("Resetting turtlesim.")
        for interface in self._turtles.values():
            interface.close()
        self._turtles.clear()
        self._named = 0
        self._spawn("", SIZE / 2, SIZE / 2, 0.0)
        self._drawing.clear()
        return response

    def _on_spawn(self, request: Any, response: Any) -> Any:
        if all(map(math.isfinite, (request.x, request.y, request.theta))):
            response.name = self._spawn(request.name, request.x, request.y, request.theta)
        else:
            self.get_logger().error("A turtle cannot be spawned where no number says")
        return response

    def _on_kill(self, request: Any, response: Any) -> Any:
        interface = self._turtles.pop(request.name, None)
        if interface is None:
            self.get_logger().error(f"Tried to kill turtle [{request.name}], which does not exist")
        else:
            interface.close()
        return response

    def _spawn(self, wanted: str, x: float, y: float, theta: float) -> str:
        """Add a turtle and return its name, empty when there cannot be one of that name."""
        from rclpy.exceptions import InvalidTopicNameException
        from rclpy.validate_topic_name import validate_topic_name

        if wanted in self._turtles:
            self.get_logger().error(f"A turtle named [{wanted}] already exists")
            return ""
        name = wanted or self._free_name()
        try:
            validate_topic_name(f"{name}/pose")
        except InvalidTopicNameException as error:
            self.get_logger().error(f"A turtle cannot be named [{name}]: {str(error).splitlines()[0]}")
            return ""
        turtle = Turtle(name, x, y, theta, kind=self._free_kind())
        self._turtles[name] = TurtleInterface(self, turtle, self._draw)
        self.wake()
        self.get_logger().info(f"Spawning turtle [{name}] at x=[{x:f}], y=[{y:f}], theta=[{theta:f}]")
        return name

    def _free_name(self) -> str:
        while True:
            self._named += 1
            name = f"turtle{self._named}"
            if name not in self._turtles:
                return name

    def _free_kind(self) -> int:
        """Return how a new turtle looks: unlike the others, while there are enough kinds."""
        taken = {interface.turtle.kind for interface in self._turtles.values()}
        return random.choice([kind for kind in range(_KINDS) if kind not in taken] or range(_KINDS))

    # The window.

    def _show(self) -> None:
        """Publish the state of the window, immediately after motion."""
        from daidalos_msgs.msg import TurtleSprite, TurtleWindow

        drawing = self._drawing
        if not self._window.handle.has_subscribers:
            self._shown = ()
            return
        turtles = [interface.turtle for interface in self._turtles.values()]
        seen = [(turtle.name, turtle.kind, turtle.x, turtle.y, turtle.theta) for turtle in turtles]
        shown = (self._background, drawing.clearings, drawing.drawn, seen)
        self._still = self._still + 1 if shown == self._shown else 0
        self._shown = shown
        if self._still % _STILL_UPDATES:
            return
        (r, g, b), (lines, pens) = self._background, drawing.news()
        self._window.publish(
            TurtleWindow(
                width=SIZE,
                height=SIZE,
                r=r,
                g=g,
                b=b,
                turtles=[TurtleSprite(name=name, kind=kind, x=x, y=y, theta=theta) for name, kind, x, y, theta in seen],
                clearings=drawing.clearings,
                drawn=drawing.drawn,
                lines=lines,
                pens=pens,
            )
        )

    def _on_drawing(self, request: Any, response: Any) -> Any:
        response.clearings, response.drawn = self._drawing.clearings, self._drawing.drawn
        response.lines, response.pens = self._drawing.all_lines()
        response.picture = self._drawing.picture()
        return response


def main() -> int:
    """Run the node."""
    parser = argparse.ArgumentParser(
        prog="turtlesim_node", description="Simulate turtles that draw.", allow_abbrev=False
    )
    parser.add_argument("--headless", action="store_true", help="open no window and serve none")
    arguments = parser.parse_args(program_arguments())
    if arguments.headless:
        return run(TurtleSim)
    return run_with_window(TurtleSim, "turtlesim", lambda node: {"window": node.window_topic})

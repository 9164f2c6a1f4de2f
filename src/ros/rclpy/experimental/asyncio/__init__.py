"""Nodes whose callbacks run in an asyncio event loop: ``async with AsyncNode("name") as node``."""

from rclpy.experimental.asyncio.client import AsyncClient
from rclpy.experimental.asyncio.clock import AsyncClock
from rclpy.experimental.asyncio.node import AsyncNode
from rclpy.experimental.asyncio.publisher import AsyncPublisher
from rclpy.experimental.asyncio.timer import AsyncTimer

__all__ = ["AsyncClient", "AsyncClock", "AsyncNode", "AsyncPublisher", "AsyncTimer"]

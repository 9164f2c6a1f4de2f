"""Experimental parts of newer distributions: an event-driven executor, and nodes for asyncio."""

from rclpy.experimental.asyncio import AsyncClient, AsyncClock, AsyncNode, AsyncPublisher, AsyncTimer
from rclpy.experimental.events_executor import EventsExecutor

__all__ = ["AsyncClient", "AsyncClock", "AsyncNode", "AsyncPublisher", "AsyncTimer", "EventsExecutor"]

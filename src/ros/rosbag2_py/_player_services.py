"""The services of a player."""

from __future__ import annotations

from typing import Any

from rclpy.callback_groups import ReentrantCallbackGroup

from rosbag2_py._player_node import PlayerNode
from rosbag2_py._services import create_common_services, serve

_SECOND = 1_000_000_000


def create_services(player: PlayerNode) -> None:
    """Create the services that control a player."""
    from rosbag2_interfaces import srv

    group = ReentrantCallbackGroup()

    def play(request: Any) -> dict[str, Any]:
        offset, duration = _nanoseconds(request.start_offset), _nanoseconds(request.playback_duration)
        until = _nanoseconds(request.playback_until_timestamp)
        return {"success": player.play_part(offset / _SECOND, duration / _SECOND, until)}

    create_common_services(player, player, group)
    for kind, name, work in (
        (srv.GetRate, "get_rate", lambda request: {"rate": player.rate}),
        (srv.SetRate, "set_rate", lambda request: {"success": player.set_rate(request.rate)}),
        (srv.PlayNext, "play_next", lambda request: {"success": player.play_next()}),
        (srv.Burst, "burst", lambda request: {"actually_burst": player.burst(request.num_messages)}),
        (srv.Seek, "seek", lambda request: {"success": player.seek(_nanoseconds(request.time))}),
        (srv.Play, "play", play),
    ):
        serve(player, kind, name, work, group)


def _nanoseconds(message: Any) -> int:
    return int(message.sec) * _SECOND + int(message.nanosec)

"""The services of a recorder."""

from __future__ import annotations

from typing import Any

from rosbag2_py._recorder_node import RecorderNode
from rosbag2_py._services import create_common_services, serve


def create_services(recorder: RecorderNode) -> None:
    """Create the services that control a recorder."""
    from rosbag2_interfaces import srv

    def record(request: Any) -> dict[str, Any]:
        try:
            recorder.record(request.uri)
        except RuntimeError as error:
            return {"return_code": 1, "error_string": str(error)}
        return {}

    def start_discovery(request: Any) -> dict[str, Any]:
        if not recorder.is_recording:
            return {"return_code": 1, "error_string": "Nothing is recorded."}
        recorder.start_discovery()
        return {}

    create_common_services(recorder, recorder)
    for kind, name, work in (
        (srv.SplitBagfile, "split_bagfile", lambda request: recorder.split()),
        (srv.Record, "record", record),
        (srv.StartDiscovery, "start_discovery", start_discovery),
        (srv.StopDiscovery, "stop_discovery", lambda request: recorder.stop_discovery()),
        (srv.IsDiscoveryRunning, "is_discovery_running", lambda request: {"running": recorder.is_discovering}),
    ):
        serve(recorder, kind, name, work)
    if recorder.keeps_snapshots:
        serve(recorder, srv.Snapshot, "snapshot", lambda request: {"success": recorder.take_snapshot()})

"""Where a process that is in the graph listens."""

import os
import subprocess
import sys

import psutil
import pytest

SCRIPT = """
import rclpy
rclpy.init()
node = rclpy.create_node("listening")
print("ready", flush=True)
input()
rclpy.shutdown()
"""


@pytest.mark.skipif(os.name != "posix", reason="this system has no sockets that are files")
def test_a_node_on_one_machine_listens_at_a_file_of_its_user_only(domain: int) -> None:
    variables = {name: value for name, value in os.environ.items() if not name.startswith(("ROS_", "RMW_", "ZENOH_"))}
    process = subprocess.Popen(
        [sys.executable, "-c", SCRIPT],
        env={**variables, "ROS_DOMAIN_ID": str(domain)},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    try:
        watched = psutil.Process(process.pid)
        assert [one for one in watched.net_connections("inet") if one.status in ("LISTEN", "NONE")] == []
        files = [one.laddr for one in watched.net_connections("unix") if str(one.laddr).endswith(".sock")]
        assert files
        for file in files:
            assert os.stat(os.path.dirname(file)).st_mode & 0o077 == 0
    finally:
        process.communicate("\n", timeout=60)

"""A simulator in this process, with a client that calls its services."""

import threading
from contextlib import suppress

import pytest
import rclpy
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor

from ros.graph import graph  # noqa: F401

WORLD = """<sdf version="1.9"><world name="shop"><include><uri>model://ground_plane</uri></include>
<include><uri>model://sun</uri></include>
<plugin name="state" filename="libgazebo_ros_state.so"><ros><namespace>/demo</namespace></ros></plugin>
<frame name="door"><pose>3 4 0 0 0 0</pose></frame>
<model name="shelf"><static>true</static><pose>2 0 0.5 0 0 0</pose><link name="board"><collision name="c"><geometry>
<box><size>1 2 1</size></box></geometry></collision></link></model></world></sdf>"""

BOX = """<sdf version="1.9"><model name="crate"><link name="body"><inertial><mass>2</mass><inertia><ixx>0.3</ixx>
<iyy>0.3</iyy><izz>0.3</izz></inertia></inertial><collision name="c"><geometry><box><size>1 1 1</size></box></geometry>
</collision></link></model></sdf>"""

ARM = """<robot name="arm"><link name="world"/><link name="base"/><link name="rod"><inertial><mass value="1"/>
<origin xyz="0.2 0 0"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="w" type="fixed"><parent link="world"/><child link="base"/></joint>
<joint name="j" type="revolute"><parent link="base"/><child link="rod"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" effort="9" velocity="9"/><dynamics damping="0.5"/></joint></robot>"""


class Shop:
    """A paused simulator and its client."""

    def __init__(self, server, client):
        self.server = server
        self.client = client
        self._clients = {}

    def call(self, kind, name, /, **fields):
        """Call a service; fields may be nested messages."""
        if name not in self._clients:
            self._clients[name] = self.client.create_client(kind, name)
            assert self._clients[name].wait_for_service(5.0), name
        response = self._clients[name].call(kind.Request(**fields), 10.0)
        assert response is not None, name
        return response


@pytest.fixture
def shop(graph, tmp_path):  # noqa: F811
    from daidalos.nodes.gazebo_ros.gzserver import GzServer, Start

    path = tmp_path / "shop.world"
    path.write_text(WORLD)
    server = GzServer(Start(path, paused=True))
    client = rclpy.create_node("client")
    executor = MultiThreadedExecutor(4)
    executor.add_node(server)
    executor.add_node(client)

    def spin():
        with suppress(ExternalShutdownException):
            executor.spin()

    thread = threading.Thread(target=spin)
    thread.start()
    try:
        yield Shop(server, client)
    finally:
        executor.shutdown()
        thread.join()
        server.destroy_node()
        client.destroy_node()

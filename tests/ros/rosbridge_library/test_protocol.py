"""A client's frames, as they come."""

import json

import rclpy
from rosbridge_library.rosbridge_protocol import RosbridgeProtocol


def test_a_lone_surrogate_can_be_logged() -> None:
    answers: list[str] = []
    with rclpy.init(args=[]):
        node = rclpy.create_node("bridge")
        protocol = RosbridgeProtocol("client", node)
        protocol.outgoing = lambda message, compression="none": answers.append(message)
        protocol.incoming(json.dumps({"op": "set_level", "level": "error"}))
        protocol.incoming(json.dumps({"op": "fly", "id": "\ud800"}))
        protocol.finish()
        node.destroy_node()
    assert len(answers) == 1

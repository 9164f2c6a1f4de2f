"""The other process of a test: ``python peer.py ROLE``. It says ``ready``, then one line for what it notices."""

from __future__ import annotations

import sys
import threading
import time

from example_interfaces.srv import AddTwoInts
from sensor_msgs.msg import Image
from std_msgs.msg import Int32

from daidalos.transport.environment import read_environment
from daidalos.transport.graph import EndpointKind
from daidalos.transport.qos import Durability, Qos, Reliability
from daidalos.transport.session import Session
from daidalos.transport.shared import make_backend

LATCHED = Qos(durability=Durability.TRANSIENT_LOCAL)


def say(text: object) -> None:
    print(text, flush=True)


def talk(session: Session, kind: type = Int32, message: object = None, pause_s: float = 0.02) -> None:
    """Publish numbers, or the same message again and again."""
    node, _remove = session.create_node("talker", "/")
    publisher = session.create_publisher(node, "/topic", kind, Qos())
    say("ready")
    number = 0
    while True:
        number += 1
        publisher.publish(Int32(data=number) if message is None else message)
        time.sleep(pause_s)


def flood(session: Session) -> None:
    """Publish large images without a pause."""
    talk(session, Image, Image(data=bytes(4_000_000)), 0.0)


def listen(session: Session) -> None:
    """Print what is heard."""
    node, _remove = session.create_node("listener", "/")
    news = threading.Event()
    subscription = session.create_subscription(node, "/topic", Int32, Qos(), news.set)
    say("ready")
    while True:
        news.wait()
        news.clear()
        while (taken := subscription.take()) is not None:
            say(f"heard {taken[0].data}")


def look(session: Session) -> None:
    """Subscribe to images and leave them."""
    node, _remove = session.create_node("looker", "/")
    _subscription = session.create_subscription(
        node, "/topic", Image, Qos(reliability=Reliability.BEST_EFFORT, depth=5)
    )
    say("ready")
    threading.Event().wait()


def keep(session: Session) -> None:
    """Keep a number on each of two latched publishers."""
    node, _remove = session.create_node("keeper", "/")
    publishers = [session.create_publisher(node, "/kept", Int32, LATCHED) for _ in range(2)]
    for number, publisher in enumerate(publishers):
        publisher.publish(Int32(data=number))
    say("ready")
    threading.Event().wait()


def serve(session: Session) -> None:
    """Add numbers."""
    node, _remove = session.create_node("server", "/")
    news = threading.Event()
    service = session.create_service(node, "/add", AddTwoInts, Qos(), news.set)
    say("ready")
    while True:
        news.wait()
        news.clear()
        while (taken := service.take()) is not None:
            request, identity, *_ = taken
            service.reply(identity, AddTwoInts.Response(sum=request.a + request.b))


def watch(session: Session) -> None:
    """Print which publishers of the topic come and go."""
    stop = session.watch(
        "/topic",
        lambda added, who: (
            say(f"{'came' if added else 'went'} {who.node.name}") if who.kind is EndpointKind.PUBLISHER else None
        ),
    )
    say("ready")
    threading.Event().wait()
    stop()


def crowd(session: Session) -> None:
    """Create many nodes with many topics."""
    nodes = [session.create_node(f"node{number}", "/crowd") for number in range(200)]
    publishers = [
        session.create_publisher(nodes[number % 200][0], "/topic" if number == 7 else f"/topic{number}", Int32, Qos())
        for number in range(3000)
    ]
    say("ready")
    threading.Event().wait()
    assert publishers


ROLES = {role.__name__: role for role in (crowd, talk, flood, keep, listen, look, serve, watch)}

if __name__ == "__main__":
    ROLES[sys.argv[1]](Session(make_backend(read_environment())))

"""A process that behaves on the wire as rmw_cyclonedds of Jazzy: ``python jazzy_peer.py ROLE``.

It uses the profiles, the library's default configuration and the `ros_discovery_info` of ROS 2. Samples are taken as
CDR through the C library, since the Python encoder would be slower than the real subscriber.
"""

from __future__ import annotations

import ctypes as c
import os
import sys
import time

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.topic import Topic
from cyclonedds.util import duration

from daidalos.transport.cyclonedds.library import DATA_AVAILABLE_STATUS, INFINITE, Guid, TopicDescriptor, load
from daidalos.transport.cyclonedds.reception import SampleReader
from transport.cyclonedds.partner import Gid, Info, Node, say

KEEP_LAST, RELIABLE = 0, 1
DEPTH = 5
ANNOUNCED = Qos(
    Policy.Reliability.Reliable(duration(infinite=True)),
    Policy.Durability.TransientLocal,
    Policy.History.KeepLast(1),
)
library = load()


class Participant:
    """A participant with one node."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._participant = DomainParticipant(int(os.environ["ROS_DOMAIN_ID"]), qos=Qos(Policy.Userdata(b"enclave=/;")))
        self.entity = self._participant._ref
        self._info = DataWriter(self._participant, Topic(self._participant, "ros_discovery_info", Info), qos=ANNOUNCED)

    def announce(self, *readers: int) -> None:
        """List the node and its readers, as ROS 2 does after every change."""
        gid = Gid(list(guid_of(self.entity)))
        self._info.write(Info(gid, [Node("/", self.name, [Gid(list(guid_of(reader))) for reader in readers], [])]))

    def subscribe(self, topic: str, type_name: bytes) -> int:
        """Return a reliable reader of the last `DEPTH` samples."""
        octet = (c.c_uint32 * 3)(0x01010000, 0, 0)
        described = TopicDescriptor(size=1, align=1, type_name=type_name, ops_count=2, ops=octet, meta=b"")
        entity = library.dds_create_topic(self.entity, c.byref(described), topic.encode(), None, None)
        qos = library.dds_create_qos()
        library.dds_qset_history(qos, KEEP_LAST, DEPTH)
        library.dds_qset_reliability(qos, RELIABLE, INFINITE)
        return library.check(library.dds_create_reader(self.entity, library.check(entity, "topic"), qos, None), "read")

    def receive(self, reader: int) -> None:
        """Print the size of every sample."""
        taker = SampleReader(library)
        waitset = library.dds_create_waitset(self.entity)
        library.dds_set_status_mask(reader, DATA_AVAILABLE_STATUS)
        library.dds_waitset_attach(waitset, reader, 1)
        while True:
            library.dds_waitset_wait(waitset, None, 0, INFINITE)
            taker.take_all(reader, lambda sample: say(f"got {len(sample.data)}"))


def guid_of(entity: int) -> bytes:
    guid = Guid()
    library.check(library.dds_get_guid(entity, c.byref(guid)), "identify")
    return bytes(guid.v)


def images() -> None:
    """Receive images."""
    peer = Participant("images")
    reader = peer.subscribe("rt/image", b"sensor_msgs::msg::dds_::Image_")
    peer.announce(reader)
    say("ready")
    peer.receive(reader)


def texts() -> None:
    """Receive texts, and never list the reader."""
    peer = Participant("texts")
    reader = peer.subscribe("rt/text", b"std_msgs::msg::dds_::String_")
    say("ready")
    peer.receive(reader)


def slow_node() -> None:
    """Join, and list the node a while after DDS has shown the participant."""
    peer = Participant("slow")
    say("ready")
    sys.stdin.close()
    time.sleep(0.8)
    peer.announce()
    time.sleep(60)


ROLES = {"images": images, "texts": texts, "slow_node": slow_node}

if __name__ == "__main__":
    ROLES[sys.argv[1]]()

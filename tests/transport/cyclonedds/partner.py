"""A DDS program that knows nothing of ROS's libraries: ``python partner.py ROLE``, on the package's own encoder."""

import os
import sys
from dataclasses import dataclass

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct, types
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

RELIABLE = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.History.KeepAll)


@dataclass
class String(IdlStruct, typename="std_msgs::msg::dds_::String_"):
    data: str


@dataclass
class Request(IdlStruct, typename="example_interfaces::srv::dds_::AddTwoInts_Request_"):
    client: types.uint64
    sequence: types.int64
    a: types.int64
    b: types.int64


@dataclass
class Reply(IdlStruct, typename="example_interfaces::srv::dds_::AddTwoInts_Response_"):
    client: types.uint64
    sequence: types.int64
    sum: types.int64


@dataclass
class Gid(IdlStruct, typename="rmw_dds_common::msg::dds_::Gid_"):
    data: types.array[types.uint8, 16]


@dataclass
class Node(IdlStruct, typename="rmw_dds_common::msg::dds_::NodeEntitiesInfo_"):
    namespace: str
    name: str
    readers: types.sequence[Gid]
    writers: types.sequence[Gid]


@dataclass
class Info(IdlStruct, typename="rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_"):
    gid: Gid
    nodes: types.sequence[Node]


def say(text: object) -> None:
    print(text, flush=True)


def samples(reader: DataReader):
    while True:
        yield from (sample for sample in reader.take_iter(timeout=duration(seconds=60)) if sample is not None)


def echo(participant: DomainParticipant) -> None:
    """Answer every text on ``/ping`` by one on ``/pong``."""
    reader = DataReader(participant, Topic(participant, "rt/ping", String), RELIABLE)
    writer = DataWriter(participant, Topic(participant, "rt/pong", String), RELIABLE)
    say("ready")
    for sample in samples(reader):
        writer.write(String(f"{sample.data} back"))


def call(participant: DomainParticipant) -> None:
    """Ask for the sum of 3 and 4."""
    writer = DataWriter(participant, Topic(participant, "rq/addRequest", Request), RELIABLE)
    reader = DataReader(participant, Topic(participant, "rr/addReply", Reply), RELIABLE)
    say("ready")
    sys.stdin.readline()
    writer.write(Request(client=0x0123456789ABCDEF, sequence=7, a=3, b=4))
    for sample in samples(reader):
        say(f"{sample.client:x} {sample.sequence} {sample.sum}")


def nodes(participant: DomainParticipant) -> None:
    """Print what processes announce of their nodes."""
    kept = Qos(Policy.Reliability.Reliable(duration(seconds=1)), Policy.Durability.TransientLocal)
    reader = DataReader(participant, Topic(participant, "ros_discovery_info", Info), kept)
    say("ready")
    for sample in samples(reader):
        for node in sample.nodes:
            gids = ["".join(f"{byte:02x}" for byte in gid.data) for gid in (*node.readers, *node.writers)]
            say(f"{node.namespace} {node.name} {bytes(sample.gid.data).hex()} {' '.join(gids)}")


ROLES = {"echo": echo, "call": call, "nodes": nodes}

if __name__ == "__main__":
    ROLES[sys.argv[1]](DomainParticipant(int(os.environ["ROS_DOMAIN_ID"])))

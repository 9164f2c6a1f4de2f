"""The built-in interface definitions: hashes, references, package manifests."""

import json
from collections.abc import Iterator
from pathlib import Path
from xml.etree import ElementTree

import pytest
from rosbags.typesys import Stores, get_typestore

import daidalos
from daidalos.interfaces.definition import Action, Interface, Message, Service, messages_of
from daidalos.interfaces.description import describe
from daidalos.interfaces.parser import parse_file

SHARE = Path(daidalos.__file__).parent / "share"
KINDS = ("msg", "srv", "action")
PACKAGES = sorted(p.name for p in SHARE.iterdir() if any((p / kind).is_dir() for kind in KINDS))

# Packages of which a real build's hashes are recorded.
HASHED_PACKAGES = (
    "action_msgs", "builtin_interfaces", "diagnostic_msgs", "example_interfaces", "geometry_msgs",
    "lifecycle_msgs", "nav_msgs", "rcl_interfaces", "rmw_dds_common", "ros2cli_test_interfaces",
    "rosgraph_msgs", "sensor_msgs", "service_msgs", "shape_msgs", "std_msgs", "std_srvs", "test_msgs",
    "tf2_msgs", "trajectory_msgs", "type_description_interfaces", "unique_identifier_msgs",
    "visualization_msgs",
)  # fmt: skip

HASHES = {
    "std_msgs/msg/String": "df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
    "std_msgs/msg/Header": "f49fb3ae2cf070f793645ff749683ac6b06203e41c891e17701b1cb597ce6a01",
    "sensor_msgs/msg/LaserScan": "64c191398013af96509d518dac71d5164f9382553fce5c1f8cca5be7924bd828",
    "example_interfaces/srv/AddTwoInts": "e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a",
    "example_interfaces/action/Fibonacci": "9508051da1ea4658de144b09bd0690ff3de52104683d847aed764d2915906f51",
    # Packages of which no hash is recorded in the shared data; read off generated code of a real build.
    "control_msgs/msg/PidState": "9ab329825048ab6152868c2d086fc19f5525ed2c6fec886f719577e1ae3a6acd",
    "control_msgs/msg/SteeringControllerStatus": ("151ec2fabdfdf10cabe982ceab9fec8882c9efff0effc8d07ba7a1d404cf8143"),
    "controller_manager_msgs/msg/ControllerManagerActivity": (
        "35b7de5d611b6780e89732de325f2f765eacdb8a7adfe5821a27af4a03a7c244"
    ),
    "dwb_msgs/msg/LocalPlanEvaluation": "6bb7af7f92591fcb4e637dd0803ca59a0b3125a0962eeb9919b55cd68db3e97b",
    "nav2_msgs/msg/Route": "e7a30327e3f17e37bb7c8d559ca6a84e189ed17725f0b6ecc02fbcceeef70184",
    "ros_gz_interfaces/msg/Light": "8efb44b207981d0c23827eae2490a4c4700c5e872f0151f0e6dd09aab4919f93",
    "slam_toolbox/srv/DeserializePoseGraph": ("ec7e27ad873d1c3961583c3288d7fe516bb0035fc9769078657f0377bd55547a"),
}

# rosbags hashes char as int8, ROS 2 as uint8.
WITH_CHAR = {
    "rmw_dds_common/msg/Gid",
    "rmw_dds_common/msg/NodeEntitiesInfo",
    "rmw_dds_common/msg/ParticipantEntitiesInfo",
    "service_msgs/msg/ServiceEventInfo",
    "std_msgs/msg/Char",
}


def files_of(package: str) -> list[Path]:
    return sorted(path for kind in KINDS for path in (SHARE / package / kind).glob("*") if path.is_file())


def with_parts(interface: Interface) -> Iterator[Interface]:
    """Yield the interface and all that it is made of."""
    yield interface
    yield from messages_of(interface)
    if isinstance(interface, Action):
        for service in (interface.send_goal, interface.get_result):
            yield service
            yield from service.messages


def packages_used(interface: Interface) -> set[str]:
    """Return the packages that a definition refers to, and the one that its kind needs."""
    match interface:
        case Message():
            parts, implied = (interface,), set()
        case Service():
            parts, implied = (interface.request, interface.response), {"service_msgs"}
        case Action():
            parts, implied = (interface.goal, interface.result, interface.feedback), {"action_msgs"}
    return implied | {name.split("/")[0] for part in parts for name in part.nested()}


@pytest.fixture(scope="module")
def catalogue() -> dict[str, Interface]:
    return {
        part.name: part
        for package in PACKAGES
        for path in files_of(package)
        for part in with_parts(parse_file(path, package))
    }


@pytest.fixture(scope="module")
def recorded(shared_data: Path) -> dict[str, str]:
    """Hashes that a real ROS 2 build gave."""
    return json.loads((shared_data / "wire" / "type_hashes.json").read_text())


def type_hash(name: str, catalogue: dict[str, Interface]) -> str:
    return describe(catalogue[name], catalogue.__getitem__).type_hash()


@pytest.mark.parametrize("package", HASHED_PACKAGES)
def test_hashes_are_those_of_a_real_build(package, catalogue, recorded):
    expected = {name: value for name, value in recorded.items() if name.split("/")[0] == package}
    assert expected
    assert {name: type_hash(name, catalogue) for name in expected} == expected


def test_no_recorded_package_is_left_out(recorded):
    assert {name.split("/")[0] for name in recorded} == set(HASHED_PACKAGES)


@pytest.mark.parametrize("name", HASHES)
def test_known_hashes(name, catalogue):
    assert type_hash(name, catalogue) == f"RIHS01_{HASHES[name]}"


def test_layouts_and_constants_are_those_that_rosbags_knows(catalogue):
    store = get_typestore(Stores.ROS2_JAZZY)
    names = [name for name in store.fielddefs if not name.startswith("actionlib_msgs/")]
    assert len(names) > 150
    for name in names:
        message = catalogue[name]
        assert isinstance(message, Message)
        constants = {constant: value for constant, _, value in store.fielddefs[name][0]}
        assert {c.name: c.value for c in message.constants} == constants, name
        if name not in WITH_CHAR:
            assert type_hash(name, catalogue) == store.hash_rihs01(name), name


@pytest.mark.parametrize("package", PACKAGES)
def test_every_reference_resolves(package, catalogue):
    names = [name for name in catalogue if name.split("/")[0] == package]
    assert names
    for name in names:
        assert type_hash(name, catalogue).startswith("RIHS01_")


@pytest.mark.parametrize("package", PACKAGES)
def test_every_file_says_first_what_it_is_for(package):
    for path in files_of(package):
        lines = path.read_text(encoding="utf-8").splitlines()
        assert lines[0].startswith("# "), path
        assert all(line == line.rstrip() and len(line) <= 110 for line in lines), path


@pytest.mark.parametrize("package", PACKAGES)
def test_manifest_lists_what_the_package_uses(package):
    manifest = ElementTree.parse(SHARE / package / "package.xml").getroot()
    assert manifest.get("format") == "3"
    assert manifest.findtext("name") == package
    assert manifest.findtext("license") == "Apache-2.0"
    assert manifest.findtext("member_of_group") == "rosidl_interface_packages"
    used = set().union(*(packages_used(parse_file(path, package)) for path in files_of(package))) - {package}
    listed = {element.text for element in manifest.findall("depend")}
    assert used <= listed


def test_packages_do_not_depend_on_each_other_in_circles():
    uses = {
        package: set().union(*(packages_used(parse_file(path, package)) for path in files_of(package))) - {package}
        for package in PACKAGES
    }
    while uses:
        free = {package for package, others in uses.items() if not others & uses.keys()}
        assert free, f"a circle among {sorted(uses)}"
        for package in free:
            del uses[package]

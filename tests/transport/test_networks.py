"""Several machines: discovery, the loss of a link, and its return."""

from __future__ import annotations

from pathlib import Path

import pytest

from transport.networks import Network, skip_unless_permitted
from transport.peers import Peer

LOSS_S = 30.0
RETURN_S = 30.0
# A link that is lost without a word is noticed when a lease runs out; here soon, so that the tests are short, yet not
# while a busy machine lets a process wait for a second or two.
QUICK_LEASES = {
    "CYCLONEDDS_URI": (
        "<CycloneDDS><Domain><Discovery><LeaseDuration>4s</LeaseDuration></Discovery></Domain></CycloneDDS>"
    ),
    "ZENOH_CONFIG_OVERRIDE": "transport/link/tx/lease=4000;transport/link/tx/keep_alive=4",
}
_ROUTER = Path(__file__).with_name("router.py")

pytestmark = pytest.mark.slow


@pytest.fixture(autouse=True)
def _environment(middleware: str, domain: int, monkeypatch: pytest.MonkeyPatch) -> None:
    skip_unless_permitted()
    monkeypatch.setenv("ROS_DOMAIN_ID", str(domain % 60))
    monkeypatch.setenv("RMW_IMPLEMENTATION", middleware)
    monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "SUBNET")
    for name, value in QUICK_LEASES.items():
        monkeypatch.setenv(name, value)


def peer(network: Network, number: int, role: str, tmp_path: Path, **environment: str) -> Peer:
    """Start a process on a machine; each machine has a runtime folder of its own."""
    folder = tmp_path / f"run{number}"
    folder.mkdir(exist_ok=True)
    return Peer(role, *network.on(number), XDG_RUNTIME_DIR=str(folder), **environment).ready()


def test_two_machines_find_lose_and_find_each_other(tmp_path):
    with (
        Network(2) as network,
        peer(network, 0, "watch", tmp_path) as watcher,
        peer(network, 0, "listen", tmp_path) as listener,
        peer(network, 1, "talk", tmp_path),
    ):
        watcher.wait_for("came talker")
        listener.wait_for("heard")
        network.cut(1)
        line = watcher.wait_for("went talker", timeout_s=LOSS_S)
        received = len(listener.lines)
        network.mend(1)
        watcher.wait_for("came talker", line, RETURN_S)
        listener.wait_for("heard", received, RETURN_S)


def test_of_three_machines_two_go_on_when_the_third_is_cut_off(tmp_path):
    with (
        Network(3) as network,
        peer(network, 0, "talk", tmp_path),
        peer(network, 1, "listen", tmp_path) as near,
        peer(network, 2, "listen", tmp_path) as far,
        peer(network, 2, "watch", tmp_path) as watcher,
    ):
        near.wait_for("heard")
        far.wait_for("heard")
        watcher.wait_for("came talker")
        network.cut(2)
        line = watcher.wait_for("went talker", timeout_s=LOSS_S)
        near.wait_for("heard", len(near.lines))
        received = len(far.lines)
        network.mend(2)
        watcher.wait_for("came talker", line, RETURN_S)
        far.wait_for("heard", received, RETURN_S)
        near.wait_for("heard", len(near.lines))
        numbers = [int(line.split()[1]) for line in near.lines if line.startswith("heard")]
        assert numbers == list(range(numbers[0], numbers[0] + len(numbers))), "some were lost between the two"


def test_a_blink_of_a_link_loses_nobody(tmp_path):
    with (
        Network(2) as network,
        peer(network, 0, "listen", tmp_path) as listener,
        peer(network, 0, "watch", tmp_path) as watcher,
        peer(network, 1, "talk", tmp_path) as talker,
    ):
        listener.wait_for("heard")
        watcher.wait_for("came talker")
        network.cut(1)
        talker_alive = talker.process.poll() is None
        network.mend(1)
        listener.wait_for("heard", len(listener.lines), RETURN_S)
        assert talker_alive
        assert not any("went" in line for line in watcher.lines)


def test_by_default_a_node_is_seen_on_its_machine_only(tmp_path):
    here = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    with (
        Network(2) as network,
        peer(network, 0, "watch", tmp_path, **here) as near,
        peer(network, 1, "watch", tmp_path) as far,
        peer(network, 0, "talk", tmp_path, **here),
        peer(network, 1, "talk", tmp_path),
    ):
        near.wait_for("came talker")
        far.wait_for("came talker")
        near.wait_for("came", 0)
        assert len([line for line in near.lines if "came" in line]) == 1
        assert len([line for line in far.lines if "came" in line]) == 1


def test_by_default_another_machine_that_knows_the_address_gets_no_answer(tmp_path, middleware):
    here = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    if middleware == "rmw_cyclonedds_cpp":
        here["CYCLONEDDS_URI"] = ""
    with Network(2) as network:
        there = {"ROS_STATIC_PEERS": network.address(0)}
        with (
            peer(network, 0, "watch", tmp_path, **here) as near,
            peer(network, 1, "watch", tmp_path, **there) as far,
            peer(network, 1, "talk", tmp_path, **there),
            peer(network, 0, "talk", tmp_path, **here),
        ):
            far.wait_for("came talker")
            line = near.wait_for("came talker")
            with pytest.raises(AssertionError):  # nothing else shows that nobody comes
                near.wait_for("came talker", line, timeout_s=5.0)
            assert len([line for line in far.lines if "came" in line]) == 1


def test_a_static_peer_is_found_without_multicast(tmp_path, middleware):
    if middleware == "rmw_zenoh_cpp":
        pytest.skip("zenoh's static peers are routers")
    environment = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
    with Network(2) as network:
        one = environment | {"ROS_STATIC_PEERS": network.address(1)}
        other = environment | {"ROS_STATIC_PEERS": network.address(0)}
        with peer(network, 0, "watch", tmp_path, **one) as watcher, peer(network, 1, "talk", tmp_path, **other):
            watcher.wait_for("came talker")


def test_a_router_joins_machines_without_multicast(tmp_path, middleware):
    """The router's machine needs no setting; the others name it. It may die and come back."""
    if middleware != "rmw_zenoh_cpp":
        pytest.skip("only zenoh has routers")
    with Network(3) as network:
        named = {"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", "ROS_STATIC_PEERS": network.address(0)}
        with (
            peer(network, 1, "listen", tmp_path, **named) as listener,
            peer(network, 1, "watch", tmp_path, **named) as watcher,
            peer(network, 2, "talk", tmp_path, **named),
        ):
            with Peer("router", *network.on(0), script=_ROUTER).ready():
                watcher.wait_for("came talker")
                listener.wait_for("heard")
            with Peer("router", *network.on(0), script=_ROUTER).ready():
                listener.wait_for("heard", len(listener.lines), RETURN_S)

"""Network interfaces by which other machines can be reached."""

from __future__ import annotations

import socket
from collections.abc import Iterable, Iterator
from typing import Any

import psutil

from daidalos.cli.ros2.checkup.subject import Findings, Report, Subject
from daidalos.transport.environment import DiscoveryRange, read_environment
from daidalos.transport.graph import Graph


class Network(Subject):
    """Network interfaces, and the discovery range of nodes."""

    category = "network"

    def check(self, graph: Graph) -> Findings:
        """Fail without an active interface; warn if other machines are to be discovered but cannot be reached."""
        up = [name for name, stats in psutil.net_if_stats().items() if stats.isup]
        if not up:
            return Findings(errors=["No network interface is up: not even processes of this machine find each other."])
        wide = read_environment().discovery is DiscoveryRange.SUBNET
        if wide and all(_is_loopback(name) for name in up):
            return Findings(warnings=["Only loopback interfaces are up: nodes on other machines cannot be found."])
        return Findings()

    def reports(self, graph: Graph) -> Iterable[Report]:
        """Return a description of every interface."""
        items: list[tuple[str, Any]] = []
        for name, addresses in psutil.net_if_addrs().items():
            items += _interface(name, addresses)
        yield Report("NETWORK CONFIGURATION", tuple(items))


def _is_loopback(name: str) -> bool:
    return any(address.address in ("127.0.0.1", "::1") for address in psutil.net_if_addrs().get(name, ()))


def _interface(name: str, addresses: list[Any]) -> Iterator[tuple[str, Any]]:
    four = [address for address in addresses if address.family is socket.AF_INET]
    six = [address.address for address in addresses if address.family is socket.AF_INET6]
    hardware = [address.address for address in addresses if address.family is psutil.AF_LINK]
    stats = psutil.net_if_stats().get(name)
    if four:
        yield "inet", four[0].address
        yield "inet4", [address.address for address in four]
    if hardware:
        yield "ether", hardware[0]
    if six:
        yield "inet6", six
    if four:
        yield "netmask", four[0].netmask
    yield "device", name
    if stats is not None:
        yield "flags", f"<{stats.flags.upper()}>"
        yield "mtu", stats.mtu
    if four and four[0].broadcast:
        yield "broadcast", four[0].broadcast


SUBJECT = Network

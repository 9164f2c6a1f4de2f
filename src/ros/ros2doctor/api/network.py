"""Network interfaces by which other machines can be reached."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from typing import Any

import psutil

from daidalos.transport.environment import DiscoveryRange, read_environment
from ros2doctor.api import DoctorCheck, DoctorReport, Report, Result
from ros2doctor.api.format import doctor_error, doctor_warn


class NetworkCheck(DoctorCheck):
    """Check that fails without an interface, and warns where machines to be discovered cannot be reached."""

    def category(self) -> str:
        """Implement `DoctorCheck`."""
        return "network"

    def check(self) -> Result:
        """Implement `DoctorCheck`."""
        result = Result()
        up = [name for name, stats in psutil.net_if_stats().items() if stats.isup]
        wide = read_environment().discovery is DiscoveryRange.SUBNET
        if not up:
            doctor_error("No network interface is up: not even processes of this machine find each other.")
            result.add_error()
        elif wide and all(_is_loopback(name) for name in up):
            doctor_warn("Only loopback interfaces are up: nodes on other machines cannot be found.")
            result.add_warning()
        return result


class NetworkReport(DoctorReport):
    """Report of the interfaces."""

    def category(self) -> str:
        """Implement `DoctorReport`."""
        return "network"

    def report(self) -> Report:
        """Implement `DoctorReport`."""
        report = Report("NETWORK CONFIGURATION")
        for name, addresses in psutil.net_if_addrs().items():
            for item in _interface(name, addresses):
                report.add_to_report(*item)
        return report


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

"""Configuration of a DDS domain from the environment variables of rmw_cyclonedds."""

from __future__ import annotations

import os
from html import escape  # xml.sax.saxutils loads urllib, http and email

from daidalos.transport.cyclonedds.loopback import FIRST_PORT, PORTS_PER_DOMAIN, drops_what_others_send
from daidalos.transport.environment import DiscoveryRange, Environment

_LOCALHOST = "127.0.0.1"
_MAX_PARTICIPANTS = 99
"""Highest index of a participant: how many processes of one machine find each other without multicast."""
_LAST_PORT = 65535
_DATA_PORT_OFFSET = 11

# A reliable writer waits while this much is on its way: enough to keep the wire busy, little enough that no
# socket's buffer overflows. What was lost nevertheless is asked for again soon.
_FLOW = (
    "<Internal><Watermarks><WhcHigh>32kB</WhcHigh><WhcHighInit>32kB</WhcHighInit></Watermarks>"
    "<NackDelay>2ms</NackDelay></Internal>"
)


def domain_config(environment: Environment) -> str:
    """Return the configuration of the domain: XML fragments, the user's ``CYCLONEDDS_URI`` last."""
    ours = f'<CycloneDDS><Domain Id="any">{_reach(environment)}{_FLOW}</Domain></CycloneDDS>'
    users = os.environ.get("CYCLONEDDS_URI", "")
    return f"{ours},{users}" if users else ours


def _reach(environment: Environment) -> str:
    """Return the configuration of the discovery range."""
    match environment.discovery:
        case DiscoveryRange.OFF:
            return f"{_MULTICAST_OFF}<Discovery><Tag>ros_discovery_off_{os.getpid()}</Tag></Discovery>"
        case DiscoveryRange.LOCALHOST:
            multicast = _MULTICAST_WITHIN_MACHINE if drops_what_others_send(environment) else _MULTICAST_OFF
            return multicast + _LARGE_DATAGRAMS + _peers(environment)
    return _peers(environment)


_MULTICAST_OFF = "<General><AllowMulticast>false</AllowMulticast></General>"
# Programs of the whole network's range announce themselves by multicast alone. What they send reaches the programs of
# this machine too; what we send with this time to live does not leave it.
_MULTICAST_WITHIN_MACHINE = (
    "<General><AllowMulticast>spdp</AllowMulticast><MulticastTimeToLive>0</MulticastTimeToLive></General>"
)
# A process that was stopped for longer than its lease (a laptop that sleeps, a breakpoint) is lost to the others, and
# they to it. Where multicast does not announce them, the library from version 11 on asks at the addresses it knew only
# every 30 s and forgets them after a minute: two such processes would find each other late or never.
_REDISCOVERY = "<SPDPInterval>5s</SPDPInterval><InitialLocatorPruneDelay>inf</InitialLocatorPruneDelay>"
# Datagrams as large as UDP permits: a large message is acknowledged some 40 times sooner. Beyond this machine, where
# a datagram of several packets is lost with any of them, the library's own sizes stay.
_LARGE_DATAGRAMS = "<General><MaxMessageSize>65500B</MaxMessageSize><FragmentSize>65000B</FragmentSize></General>"


def _peers(environment: Environment) -> str:
    """Return the configuration of unicast peers and of the predictable ports that it needs.

    This machine is always among them, so that nodes of a wider range are found by those of a narrower one: under its
    loopback address and, by `AddLocalhost`, under that of the interface in use, since the library from version 11 on
    ignores announcements that come over another interface.
    """
    highest = (_LAST_PORT - FIRST_PORT - PORTS_PER_DOMAIN * environment.domain - _DATA_PORT_OFFSET) // 2
    listed = "".join(f'<Peer address="{escape(peer)}"/>' for peer in (_LOCALHOST, *environment.static_peers))
    return (
        f"<Discovery>{_REDISCOVERY}<ParticipantIndex>auto</ParticipantIndex>"
        f"<MaxAutoParticipantIndex>{min(_MAX_PARTICIPANTS, highest)}</MaxAutoParticipantIndex>"
        f'<Peers AddLocalhost="true">{listed}</Peers></Discovery>'
    )

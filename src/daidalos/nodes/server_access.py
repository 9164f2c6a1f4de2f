"""Who may connect to a server of a node, and what is said where that is everyone on the network."""

from __future__ import annotations

import os
import ssl
import sys
from dataclasses import dataclass
from pathlib import Path

from rclpy.node import Node

from daidalos.common.errors import Location, UserError
from daidalos.studio.guarded_server import LOOPBACK, GuardedServer

TOKEN_VARIABLE = "DAIDALOS_STUDIO_TOKEN"
"""Environment variable of the token; parameters of nodes can be read by everyone in the graph."""
MIN_TOKEN_LENGTH = 16


@dataclass(frozen=True)
class Access:
    """Settings of who may connect to a studio.

    Attributes
    ----------
    hosts, origins
        See `daidalos.studio.access.AccessPolicy`.
    certificate, key
        Files in PEM format; None: connections are not encrypted. The key may be in the certificate's file.
    """

    hosts: tuple[str, ...] = ()
    origins: tuple[str, ...] = ()
    certificate: Path | None = None
    key: Path | None = None

    @classmethod
    def of(
        cls,
        hosts: tuple[str, ...] = (),
        origins: tuple[str, ...] = (),
        *,
        tls: bool = False,
        certfile: str = "",
        keyfile: str = "",
    ) -> Access:
        """Return the settings of a node's parameters, in which an empty text stands for nothing.

        Raises
        ------
        UserError
            When the connection is to be encrypted and there is no certificate.
        """
        if tls and not certfile:
            raise UserError("the parameter 'tls' needs 'certfile', a certificate in PEM format")
        return cls(
            tuple(filter(None, hosts)),
            tuple(filter(None, origins)),
            Path(certfile).expanduser() if tls else None,
            Path(keyfile).expanduser() if tls and keyfile else None,
        )

    def tls_context(self) -> ssl.SSLContext | None:
        """Return what encrypts connections, None where nothing does.

        Raises
        ------
        UserError
            When the certificate cannot be used.
        """
        return None if self.certificate is None else _tls(self.certificate, self.key or self.certificate)


def listening_hosts(address: str) -> tuple[str, ...]:
    """Return the addresses to listen on for a node's parameter: those of loopback where it is empty."""
    return (address,) if address else LOOPBACK


def warn_of_exposure(node: Node, server: GuardedServer, what: str, scheme: str = "http") -> None:
    """Print the address for other machines, and warn of what they can do, where they can reach the server.

    The token goes to the terminal only: whoever is in the graph reads the log on ``/rosout``.
    """
    url = server.remote_url
    if url is None:
        return
    if scheme != "http":
        url = url.replace("http", scheme, 1)
    print(f"{what} for other machines: {url}", file=sys.stderr, flush=True)
    secrecy = "" if server.is_encrypted else "; the connection is not encrypted"
    node.get_logger().warning(
        "whoever on the network has this address with its token sees the graph, publishes, calls services and "
        f"sets parameters{secrecy}"
    )


def chosen_token() -> str | None:
    """Return the token that the user set, None where there is none."""
    token = os.environ.get(TOKEN_VARIABLE) or None
    if token is not None and len(token) < MIN_TOKEN_LENGTH:
        raise UserError(f"{TOKEN_VARIABLE} has {len(token)} characters, expected at least {MIN_TOKEN_LENGTH}")
    return token


def _tls(certificate: Path, key: Path) -> ssl.SSLContext:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    for file in (certificate, key):
        if not file.is_file():
            raise UserError("there is no such file, expected a certificate or key in PEM format", Location(str(file)))
    try:
        context.load_cert_chain(certificate, key, password="")  # without one, it would be asked for
    except (OSError, ValueError) as error:
        reason = error.reason or str(error) if isinstance(error, ssl.SSLError) else str(error)
        raise UserError(f"cannot be used with the key '{key}': {reason}", Location(str(certificate))) from None
    return context

"""Keystores for ROS 2 over zenoh with TLS: a certificate authority and the certificates of enclaves.

A keystore is a folder::

    public/ca.cert.pem                     what everybody checks certificates against
    private/ca.key.pem                     what certificates are signed with; keep it to yourself
    router/{cert.pem,key.pem,router.json5}
    enclaves/<enclave>/{cert.pem,key.pem,ca.cert.pem,session.json5,permissions.xml}

A process enters its enclave with ``ZENOH_SESSION_CONFIG_URI=<keystore>/enclaves/<enclave>/session.json5``; the
router is started with ``router/router.json5``.
"""

from __future__ import annotations

import json
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from daidalos.cli.ros2.errors import CliError

_ROUTER_PORT = 7447


@dataclass(frozen=True)
class Keystore:
    """Keystore at a path, which may not exist yet."""

    root: Path

    @property
    def authority(self) -> Path:
        """Path of the authority's certificate."""
        return self.root / "public" / "ca.cert.pem"

    @property
    def authority_key(self) -> Path:
        """Path of the authority's key."""
        return self.root / "private" / "ca.key.pem"

    @property
    def exists(self) -> bool:
        """Whether the keystore exists."""
        return self.authority.is_file() and self.authority_key.is_file()

    def require(self) -> None:
        """Raise CliError unless the keystore exists."""
        if not self.exists:
            raise CliError(
                f"'{self.root}' is not a valid keystore; `ros2 security create_keystore {self.root}` makes one"
            )

    def create(self) -> None:
        """Create the keystore with an authority and the router's certificate; CliError without cryptography."""
        from daidalos.cli.ros2.keystore.certificates import new_authority

        for folder in ("public", "private", "router", "enclaves"):
            (self.root / folder).mkdir(parents=True, exist_ok=True)
        (self.root / "private").chmod(0o700)
        new_authority(self.authority, self.authority_key)
        self._certify(self.root / "router", "router")
        listen = {"mode": "router", "listen": {"endpoints": [f"tls/[::]:{_ROUTER_PORT}"]}}
        _write_config(self.root / "router" / "router.json5", listen | self._transport(self.root / "router"))

    def enclave(self, name: str) -> Path:
        """Return an enclave's folder; CliError for an invalid name."""
        parts = name.split("/")[1:]
        if not name.startswith("/") or not all(part.replace("_", "a").isalnum() for part in parts):
            raise CliError(f"'{name}' is not a valid enclave name: it is absolute, such as /lab/talker")
        return self.root.joinpath("enclaves", *parts)

    def enclaves(self) -> list[str]:
        """Return the names of the enclaves, sorted."""
        folder = self.root / "enclaves"
        return sorted(f"/{path.parent.relative_to(folder).as_posix()}" for path in folder.rglob("cert.pem"))

    def create_enclave(self, name: str) -> None:
        """Create an enclave: its certificate and the configuration of its sessions."""
        folder = self.enclave(name)
        folder.mkdir(parents=True)
        self._certify(folder, name)
        shutil.copyfile(self.authority, folder / "ca.cert.pem")
        self.configure_enclave(name, None)

    def configure_enclave(self, name: str, access: dict[str, Any] | None) -> None:
        """Write the configuration of an enclave's sessions; `access` is zenoh's access control, None for none."""
        folder = self.enclave(name)
        config = {
            "mode": "peer",
            "connect": {"endpoints": [f"tls/localhost:{_ROUTER_PORT}"]},
            "listen": {"endpoints": ["tls/localhost:0"]},
            "scouting": {"multicast": {"enabled": False}, "gossip": {"enabled": True}},
        }
        if access is not None:
            config["access_control"] = access
        _write_config(folder / "session.json5", config | self._transport(folder))

    def _certify(self, folder: Path, name: str) -> None:
        from daidalos.cli.ros2.keystore.certificates import new_certificate

        new_certificate(name, folder / "cert.pem", folder / "key.pem", self.authority, self.authority_key)

    def _transport(self, folder: Path) -> dict[str, Any]:
        certificate, key = str(folder.resolve() / "cert.pem"), str(folder.resolve() / "key.pem")
        tls = {
            "root_ca_certificate": str(self.authority.resolve()),
            "listen_certificate": certificate,
            "listen_private_key": key,
            "connect_certificate": certificate,
            "connect_private_key": key,
            "enable_mtls": True,
            # Certificates name enclaves, not hosts.
            "verify_name_on_connect": False,
        }
        return {"transport": {"link": {"tls": tls}}}


def _write_config(path: Path, config: dict[str, Any]) -> None:
    path.write_text(json.dumps(config, indent=2) + "\n", encoding="utf-8")

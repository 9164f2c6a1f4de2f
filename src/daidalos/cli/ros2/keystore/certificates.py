"""X.509 certificates (RFC 5280): authority and signed certificates."""

from __future__ import annotations

import datetime
from importlib import import_module
from pathlib import Path
from typing import Any

from daidalos.cli.ros2.errors import CliError

try:
    _x509: Any = import_module("cryptography.x509")
    _hashes: Any = import_module("cryptography.hazmat.primitives.hashes")
    _serialization: Any = import_module("cryptography.hazmat.primitives.serialization")
    _ec: Any = import_module("cryptography.hazmat.primitives.asymmetric.ec")
except ModuleNotFoundError:
    raise CliError("Certificates need the package 'cryptography'; add it with: pip install cryptography") from None

_TEN_YEARS = datetime.timedelta(days=3653)
_AUTHORITY = "sros2CA"


def new_authority(certificate: Path, key: Path) -> None:
    """Write the key and the certificate of a new authority."""
    private = _ec.generate_private_key(_ec.SECP256R1())
    name = _name(_AUTHORITY)
    constraints = _x509.BasicConstraints(ca=True, path_length=1)
    built = _builder(name, name, private.public_key()).add_extension(constraints, critical=True)
    _write(built.sign(private, _hashes.SHA256()), private, certificate, key)


def new_certificate(name: str, certificate: Path, key: Path, authority: Path, authority_key: Path) -> None:
    """Write a new key and its certificate, signed by an authority."""
    signer = _x509.load_pem_x509_certificate(authority.read_bytes())
    signer_key: Any = _serialization.load_pem_private_key(authority_key.read_bytes(), None)
    private = _ec.generate_private_key(_ec.SECP256R1())
    uses = _x509.ExtendedKeyUsage(
        [_x509.oid.ExtendedKeyUsageOID.SERVER_AUTH, _x509.oid.ExtendedKeyUsageOID.CLIENT_AUTH]
    )
    built = (
        _builder(_name(name), signer.subject, private.public_key())
        .add_extension(_x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(uses, critical=False)
        .add_extension(_x509.SubjectAlternativeName([_x509.DNSName("localhost")]), critical=False)
    )
    _write(built.sign(signer_key, _hashes.SHA256()), private, certificate, key)


def _name(common_name: str) -> Any:
    return _x509.Name([_x509.NameAttribute(_x509.oid.NameOID.COMMON_NAME, common_name)])


def _builder(subject: Any, issuer: Any, public_key: Any) -> Any:
    now = datetime.datetime.now(datetime.UTC)
    return (
        _x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(issuer)
        .public_key(public_key)
        .serial_number(_x509.random_serial_number())
        .not_valid_before(now - datetime.timedelta(hours=1))
        .not_valid_after(now + _TEN_YEARS)
    )


def _write(signed: Any, private: Any, certificate: Path, key: Path) -> None:
    certificate.write_bytes(signed.public_bytes(_serialization.Encoding.PEM))
    key.touch(mode=0o600)
    key.write_bytes(
        private.private_bytes(
            _serialization.Encoding.PEM, _serialization.PrivateFormat.PKCS8, _serialization.NoEncryption()
        )
    )

"""The certificates of a site: one authority, and what it signs for the hub and for each member.

All are X.509, version 3. What an authority signs says what it is for: the first hub's serves, a
member's connects, neither does for the other, and a further hub's does both.
"""

import datetime
import ipaddress
from collections.abc import Sequence
from dataclasses import dataclass

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from inhand_hub.parameters import DEFAULT_HUB

PrivateKey = ec.EllipticCurvePrivateKey


@dataclass(frozen=True)
class Validity:
    """From when until when a certificate is valid, in UTC."""

    begin: datetime.datetime
    end: datetime.datetime


@dataclass(frozen=True)
class Issued:
    """A certificate (PEM), and its key; who keeps its key has it unchanged."""

    certificate: bytes
    key: PrivateKey
    ends_at: float
    """Seconds since the epoch."""


def from_now(days: float) -> Validity:
    """Return so many days, from a little before now."""
    now = datetime.datetime.now(datetime.UTC)
    begin = now - datetime.timedelta(seconds=DEFAULT_HUB.backdated_s)
    return Validity(begin, now + datetime.timedelta(days=days))


def new_authority(common_name: str, validity: Validity | None = None) -> Issued:
    """Make an authority, which signs itself."""
    key = new_key()
    builder = _builder(common_name, key, validity or from_now(DEFAULT_HUB.authority_days))
    usage = _usage(signs=True)
    builder = builder.issuer_name(_name(common_name)).add_extension(usage, critical=True)
    builder = builder.add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
    return _signed(builder, key, by=key)


def member_certificate(
    authority: Issued, common_name: str, key: PrivateKey, validity: Validity | None = None
) -> Issued:
    """Sign what a member connects with."""
    purpose = x509.ExtendedKeyUsage([ExtendedKeyUsageOID.CLIENT_AUTH])
    return _leaf(authority, common_name, key, purpose, (common_name,), validity)


def hub_certificate(
    authority: Issued,
    common_name: str,
    key: PrivateKey,
    hosts: Sequence[str],
    validity: Validity | None = None,
    *,
    connects: bool = False,
) -> Issued:
    """Sign what a hub serves with, under the names and addresses by which others reach it; one that
    ``connects`` to another hub shows it the same."""
    connecting = [ExtendedKeyUsageOID.CLIENT_AUTH] if connects else []
    purpose = x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH, *connecting])
    return _leaf(authority, common_name, key, purpose, hosts, validity)


def new_key() -> PrivateKey:
    """Make a private key."""
    return ec.generate_private_key(ec.SECP256R1())


def key_pem(key: PrivateKey) -> bytes:
    """Write a private key, not encrypted: its file is what keeps it."""
    return key.private_bytes(
        serialization.Encoding.PEM,
        serialization.PrivateFormat.PKCS8,
        serialization.NoEncryption(),
    )


def load_key(data: bytes) -> PrivateKey:
    """Read a private key; raises ValueError for what is none of ours."""
    try:
        key = serialization.load_pem_private_key(data, None)
    except (TypeError, ValueError):
        raise ValueError("it holds no private key of ours") from None
    if not isinstance(key, ec.EllipticCurvePrivateKey):
        raise ValueError("it holds no private key of ours")
    return key


def load_issued(certificate: bytes, key: bytes) -> Issued:
    """Read a certificate and its key; raises ValueError for what does not belong together."""
    loaded, private = x509.load_pem_x509_certificate(certificate), load_key(key)
    if loaded.public_key() != private.public_key():
        raise ValueError("certificate and key do not belong together")
    return Issued(certificate, private, loaded.not_valid_after_utc.timestamp())


def _leaf(
    authority: Issued,
    common_name: str,
    key: PrivateKey,
    purpose: x509.ExtendedKeyUsage,
    hosts: Sequence[str],
    validity: Validity | None,
) -> Issued:
    issuer = x509.load_pem_x509_certificate(authority.certificate)
    names = x509.SubjectAlternativeName([_general_name(host) for host in hosts])
    builder = _builder(common_name, key, validity or from_now(DEFAULT_HUB.member_days))
    builder = builder.issuer_name(issuer.subject).add_extension(_usage(signs=False), critical=True)
    builder = builder.add_extension(
        x509.BasicConstraints(ca=False, path_length=None), critical=True
    )
    builder = builder.add_extension(purpose, critical=False).add_extension(names, critical=False)
    builder = builder.add_extension(
        x509.AuthorityKeyIdentifier.from_issuer_public_key(authority.key.public_key()),
        critical=False,
    )
    return _signed(builder, key, by=authority.key)


def _builder(common_name: str, key: PrivateKey, validity: Validity) -> x509.CertificateBuilder:
    return (
        x509.CertificateBuilder()
        .subject_name(_name(common_name))
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(validity.begin)
        .not_valid_after(validity.end)
        .add_extension(x509.SubjectKeyIdentifier.from_public_key(key.public_key()), critical=False)
    )


def _signed(builder: x509.CertificateBuilder, key: PrivateKey, by: PrivateKey) -> Issued:
    certificate = builder.sign(by, hashes.SHA256())
    pem = certificate.public_bytes(serialization.Encoding.PEM)
    return Issued(pem, key, certificate.not_valid_after_utc.timestamp())


def _usage(*, signs: bool) -> x509.KeyUsage:
    return x509.KeyUsage(
        digital_signature=not signs,
        content_commitment=False,
        key_encipherment=False,
        data_encipherment=False,
        key_agreement=False,
        key_cert_sign=signs,
        crl_sign=signs,
        encipher_only=False,
        decipher_only=False,
    )


def _name(common_name: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, common_name)])


def _general_name(host: str) -> x509.GeneralName:
    try:
        return x509.IPAddress(ipaddress.ip_address(host))
    except ValueError:
        return x509.DNSName(host)

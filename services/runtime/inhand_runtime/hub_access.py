"""Whether this process can show a hub a certificate that the hub takes, and if not, why.

Zenoh says "Timeout!" of every reason, so certificates are looked at before it connects, and a hub
that lets nobody in is asked again by plain TLS, which names the reason.
"""

import contextlib
import logging
import socket
import ssl
import stat
import time
from pathlib import Path
from typing import NoReturn

from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.settings import Credentials, Login, ZenohSettings, is_credential
from inhand_runtime.wording import counted

log = logging.getLogger(__name__)

CONNECT_S = 2.0
WARNED_DAYS = 30
"""Days before the end of a certificate from which on each start asks for its renewal."""
DAY_S = 86_400.0
RENEW = "have it renewed (`inhand hub renew`), and copy it here"

_REFUSALS = {
    "CERTIFICATE_EXPIRED": "your certificate has expired: " + RENEW,
    "UNKNOWN_CA": "your certificate is of another authority than the hub's: copy the files that "
    "`inhand hub add` of this site made",
    "BAD_CERTIFICATE": "your certificate is none that it takes: copy the files that `inhand hub "
    "add` of this site made",
    "HANDSHAKE_FAILURE": "it takes other certificates: copy the files that `inhand hub add` of "
    "this site made",
}
_VERIFY_EXPIRED, _VERIFY_NOT_YET = 10, 9


def require_usable(given: Credentials, *, serves: bool = False) -> float:
    """Look at a process's own files as the other side will: a hub's ``serves``, else a client's.

    Returns the days that the certificate has left, and logs it where they are few. Raises
    SettingsError, or InhandError where a certificate's time has run out, or has not come.
    """
    server = _context(ssl.PROTOCOL_TLS_SERVER, given)
    server.verify_mode = ssl.CERT_NONE if serves else ssl.CERT_REQUIRED
    client = _context(ssl.PROTOCOL_TLS_CLIENT, given)
    client.check_hostname = False
    client.verify_mode = ssl.CERT_REQUIRED if serves else ssl.CERT_NONE
    try:
        days = (_shown(server, client, by_server=serves) - time.time()) / DAY_S
    except ssl.SSLCertVerificationError as error:
        if error.verify_code == _VERIFY_EXPIRED:
            raise InhandError(
                f"certificate {given.certificate} has expired, or this machine's clock is wrong: "
                + RENEW
            ) from None
        if error.verify_code == _VERIFY_NOT_YET:
            raise InhandError(
                f"certificate {given.certificate} is not valid yet: is this machine's clock right?"
            ) from None
        raise SettingsError(
            f"certificate {given.certificate} is none that authority {given.authority} gave for "
            f"this ({error.verify_message}): copy the files that `inhand hub` made"
        ) from None
    except ssl.SSLError as error:
        raise SettingsError(
            f"certificate {given.certificate} cannot be used: {error.reason}"
        ) from None
    warn_of_readers("key", given.key)
    if days < WARNED_DAYS:
        log.warning(
            "certificate %s ends in %s: %s", given.certificate, counted(int(days), "day"), RENEW
        )
    return days


def require_client(settings: ZenohSettings) -> None:
    """Look at what a client shows a hub, as the hub will; raises SettingsError or InhandError."""
    if settings.credentials is not None:
        require_usable(settings.credentials)
    if settings.login is not None:
        _trusting(settings.login.authority)
        read_password(settings.login)


def read_password(login: Login) -> str:
    """Read a client's password; raises SettingsError for a file that holds none."""
    _require_readable("password", login.password)
    warn_of_readers("password", login.password)
    words = login.password.read_text(encoding="utf-8", errors="replace").split()
    if len(words) != 1:
        raise SettingsError(
            f"password {login.password} holds no password, which is one word: copy the file that "
            "`inhand hub add` made"
        )
    return words[0]


def why_closed(settings: ZenohSettings) -> str:
    """Return why no hub lets this process in, as far as each of its addresses says."""
    given = settings.credentials or settings.login
    return "; ".join(_why_closed(address, given) for address in settings.connect)


def _why_closed(address: str, given: Credentials | Login | None) -> str:
    protocol, _, place = address.partition("/")
    host, _, port = place.partition("#")[0].partition("?")[0].rpartition(":")
    host = host.strip("[]")
    try:
        with socket.create_connection((host, int(port)), CONNECT_S) as connection:
            if protocol != "tls" or given is None:
                return (
                    f"no hub answers at {address}, though something listens there: it may want "
                    "tls, with certificate, key and authority"
                )
            return f"the hub at {address}: {_tls_refusal(connection, host, given)}"
    except (OSError, ValueError):
        return f"no hub answers at {address}: check that it runs, the address, and firewalls"


def _tls_refusal(connection: socket.socket, host: str, given: Credentials | Login) -> str:
    by_password = isinstance(given, Login)
    if isinstance(given, Login):
        context = _trusting(given.authority)
    else:
        context = _context(ssl.PROTOCOL_TLS_CLIENT, given)
    try:
        with context.wrap_socket(connection, server_hostname=host) as secured:
            # A server of TLS 1.3 looks at the client's certificate after the client is through.
            secured.recv(1)
    except ssl.SSLCertVerificationError as error:
        return (
            f"it cannot be trusted ({error.verify_message}): check zenoh.authority, and that the "
            "address is one that `inhand hub init` was given as a host"
        )
    except ssl.SSLError as error:
        if by_password:
            return (
                f"it lets nobody in by password ({error.reason}): the address is to be that of a "
                "hub with passwords"
            )
        for name, text in _REFUSALS.items():
            if name in (error.reason or ""):
                return text
        return f"it refuses the connection ({error.reason}): is it a hub that speaks TLS?"
    except TimeoutError:
        it_takes = "" if by_password else "takes this certificate, and "
        return f"it {it_takes}does not answer: is it overloaded, or stopped?"
    if by_password:
        return (
            "it does not take this user with this password: was it renewed, or revoked? Copy the "
            "file that `inhand hub` made"
        )
    return (
        "it ends the connection: is it a hub of Inhand, of this release, and not one for members "
        "with passwords?"
    )


def _context(protocol: int, given: Credentials) -> ssl.SSLContext:
    """Return TLS with these files; raises SettingsError for those that cannot be read."""
    for name in ("certificate", "key", "authority"):
        _require_readable(name, getattr(given, name))
    context = ssl.SSLContext(protocol)

    def encrypted() -> NoReturn:
        raise SettingsError(f"key {given.key} is encrypted: write it without a password")

    try:
        context.load_cert_chain(given.certificate, given.key, password=encrypted)
    except ssl.SSLError as error:
        raise SettingsError(
            f"certificate {given.certificate} and key {given.key} are no pair of PEM files: "
            f"{error.reason or 'nothing in them can be read'}"
        ) from None
    _trust(context, given.authority)
    return context


def _trusting(authority: Path) -> ssl.SSLContext:
    """Return TLS of a client that shows no certificate; raises SettingsError."""
    _require_readable("authority", authority)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    _trust(context, authority)
    return context


def _trust(context: ssl.SSLContext, authority: Path) -> None:
    try:
        context.load_verify_locations(authority)
    except ssl.SSLError as error:
        raise SettingsError(
            f"authority {authority} is no certificate (PEM): "
            f"{error.reason or 'nothing in it can be read'}"
        ) from None


def _require_readable(name: str, path: Path) -> None:
    try:
        path.read_bytes()
    except OSError as error:
        raise SettingsError(f"cannot read {name} {path}: {error.strerror}") from None


def warn_of_readers(name: str, path: Path) -> None:
    """Log that others may read a file; of what systemd gives, the group's bits say nothing."""
    if path.stat().st_mode & (stat.S_IRGRP | stat.S_IROTH) and not is_credential(path):
        log.warning("other users of this machine may read %s %s: chmod 600", name, path)


def _shown(server: ssl.SSLContext, client: ssl.SSLContext, *, by_server: bool) -> float:
    """Show a side's certificate to the other in memory; return when it ends, in seconds since the
    epoch. Raises SSLError as the side that looks does."""
    to_server, to_client = ssl.MemoryBIO(), ssl.MemoryBIO()
    sides = (
        client.wrap_bio(to_client, to_server, server_side=False),
        server.wrap_bio(to_server, to_client, server_side=True),
    )
    for _ in range(4):
        for side in sides:
            with contextlib.suppress(ssl.SSLWantReadError):
                side.do_handshake()
    certificate = sides[0 if by_server else 1].getpeercert() or {}
    return float(ssl.cert_time_to_seconds(str(certificate["notAfter"])))

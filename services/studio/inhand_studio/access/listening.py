"""The sockets that the gate listens at, and the address of the server behind it."""

import errno
import secrets
import socket

from inhand_runtime.errors import InhandError, SettingsError

from inhand_studio.access.parameters import DEFAULT_GATE

_MENDS = {
    errno.EADDRINUSE: "another program listens there: end it, or choose another port",
    errno.EACCES: "ports below 1024 are for root alone: choose another port",
    errno.EADDRNOTAVAIL: "this machine has no such address: choose another host",
}


def addresses_of(host: str) -> tuple[tuple[socket.AddressFamily, str], ...]:
    """Return the addresses that a host's name stands for; raises SettingsError where none."""
    try:
        found = socket.getaddrinfo(host, None, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)
    except (OSError, UnicodeError) as error:
        reason = getattr(error, "strerror", None) or "it is no host name"
        raise SettingsError(f"the studio's host {host!r} is no address: {reason}") from None
    return tuple(dict.fromkeys((one[0], str(one[4][0])) for one in found))


def listen(host: str, port: int) -> list[socket.socket]:
    """Listen at all addresses of a host, at one port: a free one where it is 0.

    Raises InhandError where that cannot be, and listens nowhere then.
    """
    sockets: list[socket.socket] = []
    try:
        for family, address in addresses_of(host):
            sockets.append(_listening(family, address, port))
            port = sockets[-1].getsockname()[1]
    except OSError as error:
        for one in sockets:
            one.close()
        mend = _MENDS.get(error.errno or 0, error.strerror)
        raise InhandError(f"the studio cannot listen at {host}, port {port}: {mend}") from None
    return sockets


def secluded_address() -> str:
    """Return an address of this machine that no web page comes upon: one of 16 million.

    Where the machine has but one such address it is that one. Other users of the machine can see
    what listens where; a page in a browser cannot.
    """
    for _ in range(DEFAULT_GATE.address_tries):
        address = f"127.{1 + secrets.randbelow(254)}.{secrets.randbelow(256)}"
        address = f"{address}.{1 + secrets.randbelow(254)}"
        with socket.socket() as tried:
            try:
                tried.bind((address, 0))
            except OSError:  # not every system has the whole network
                continue
            return address
    return "127.0.0.1"


def _listening(family: socket.AddressFamily, address: str, port: int) -> socket.socket:
    both = address == "::" and socket.has_dualstack_ipv6()
    return socket.create_server((address, port), family=family, dualstack_ipv6=both)

"""Which host names and origins a request may carry.

A page of any site can name a host of its own that its name server says is this machine (DNS
rebinding), and can open a WebSocket to any address: the first shows in the header ``Host``, the
second in ``Origin``.
"""

import ipaddress
import re
from collections.abc import Collection
from urllib.parse import urlsplit

_AUTHORITY = re.compile(r"(?P<name>\[[0-9A-Fa-f:.]+\]|[A-Za-z0-9._-]+)(:(?P<port>\d{1,5}))?")
_USUAL_PORTS = {"http": 80, "https": 443}


def is_loopback(address: str) -> bool:
    """Whether an address is one that only this machine reaches."""
    return ipaddress.ip_address(address.partition("%")[0]).is_loopback


def host_is_known(host: str | None, names: Collection[str], *, elsewhere: bool) -> bool:
    """Whether a header ``Host`` names this studio: with a name of this machine alone, one of the
    ``names``, or where it is reached from ``elsewhere`` any address, which no name server gives."""
    match = _AUTHORITY.fullmatch(host or "")
    if match is None:
        return False
    name = match["name"].lower().removesuffix(".")
    if name == "localhost" or name in {one.lower().removesuffix(".") for one in names}:
        return True
    try:
        address = ipaddress.ip_address(name.strip("[]"))
    except ValueError:
        return False
    return elsewhere or address.is_loopback


def origin_is_own(origin: str | None, host: str) -> bool:
    """Whether a header ``Origin`` is of a page that the ``Host`` itself served."""
    if origin is None:
        return False
    try:
        parts = urlsplit(origin)
        usual = _USUAL_PORTS[parts.scheme]
        return (parts.hostname, parts.port or usual) == _name_and_port(host, usual)
    except (KeyError, ValueError):
        return False


def _name_and_port(host: str, usual: int) -> tuple[str | None, int]:
    parts = urlsplit(f"//{host}")
    return parts.hostname, parts.port or usual

"""Who may pass the gate, as its settings say."""

import logging
import ssl
from dataclasses import dataclass

from inhand_runtime.errors import SettingsError

from inhand_studio.access.certificate import tls_of
from inhand_studio.access.hosts import is_loopback
from inhand_studio.access.listening import addresses_of
from inhand_studio.access.password import Password, password_of
from inhand_studio.access.settings import AccessSettings

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Terms:
    """Who may pass: ``elsewhere`` says that other machines reach the gate."""

    names: tuple[str, ...]
    elsewhere: bool
    password: Password | None
    tls: ssl.SSLContext | None


def terms_of(settings: AccessSettings) -> Terms:
    """Check all that can be known before a start, and listen nowhere; raises SettingsError."""
    elsewhere = not all(is_loopback(address) for _, address in addresses_of(settings.host))
    password, tls = password_of(settings), tls_of(settings)
    if elsewhere and password is None:
        raise SettingsError(
            f"other machines reach the studio at {settings.host}, and it shows the home: give it a "
            'password_file, or host = "127.0.0.1" to show it on this machine alone'
        )
    if elsewhere and tls is None:
        log.warning(
            "the studio at %s is not encrypted: who is in its network can read what it shows, and "
            "its password; give it certificate and private_key",
            settings.host,
        )
    return Terms(settings.names, elsewhere, password, tls)

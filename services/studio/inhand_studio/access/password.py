"""The password of a studio, which is compared but never shown."""

import hashlib
import hmac
import logging
import secrets
import stat
from pathlib import Path

from inhand_runtime.errors import SettingsError

from inhand_studio.access.parameters import DEFAULT_GATE
from inhand_studio.access.settings import AccessSettings

log = logging.getLogger(__name__)


class Password:
    """Knows a password by a keyed digest alone, so that nothing can print it."""

    def __init__(self, text: str) -> None:
        self._key = secrets.token_bytes(32)
        self._digest = self._digest_of(text)

    def matches(self, text: str) -> bool:
        """Whether a text is the password, in a time that says nothing of how near it is."""
        return hmac.compare_digest(self._digest, self._digest_of(text))

    def _digest_of(self, text: str) -> bytes:
        return hashlib.blake2b(text.encode("utf-8", "surrogatepass"), key=self._key).digest()


def password_of(settings: AccessSettings) -> Password | None:
    """Return the password that the settings name, if any; raises SettingsError."""
    if settings.password is not None:
        return Password(settings.password.get_secret_value())
    if settings.password_file is not None:
        return Password(_read(settings.password_file))
    return None


def _read(path: Path) -> str:
    """Return the only line of a password's file."""
    try:
        if path.stat().st_mode & stat.S_IROTH:
            log.warning("every user of this machine may read password_file %s: chmod 600", path)
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise SettingsError(f"cannot read password_file {path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise SettingsError(f"password_file {path} is no UTF-8 text") from None
    lines = text.removesuffix("\n").removesuffix("\r").split("\n")
    if len(lines) != 1:
        raise SettingsError(f"password_file {path} has several lines: the password is one line")
    if len(lines[0]) < DEFAULT_GATE.fewest_characters:
        raise SettingsError(
            f"the password in password_file {path} is short: give it "
            f"{DEFAULT_GATE.fewest_characters} characters or more"
        )
    return lines[0]

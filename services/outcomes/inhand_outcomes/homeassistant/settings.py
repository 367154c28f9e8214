"""What a settings file says of Home Assistant's broker."""

import ssl
from typing import Annotated, Self

from inhand_runtime.errors import SettingsError
from inhand_runtime.settings import FilePath, Section, is_credential
from pydantic import Field, model_validator

PLAIN_PORT, TLS_PORT = 1883, 8883
NO_WILDCARDS = r"^[^+#/\s\x00]+(/[^+#/\s\x00]+)*$"


class HomeAssistantSettings(Section):
    """``[outcomes.NAME.homeassistant]``: the MQTT broker that Home Assistant uses.

    ``tls`` checks the broker's certificate by the system's authorities, ``authority`` (PEM) by its
    own: there is no way not to check it. ``discovery_prefix`` is that of Home Assistant's MQTT
    integration. ``single_components`` is for Home Assistant before 2024.11, which knows no message
    for a whole device.
    """

    host: Annotated[str, Field(min_length=1)]
    port: Annotated[int, Field(ge=1, le=65535)] | None = None
    user: Annotated[str, Field(min_length=1)] | None = None
    password_file: FilePath | None = None
    tls: bool = False
    authority: FilePath | None = None
    discovery_prefix: Annotated[str, Field(pattern=NO_WILDCARDS)] = "homeassistant"
    single_components: bool = False

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if self.password_file is not None and self.user is None:
            raise ValueError("password_file needs user: brokers take no password alone")
        return self

    @property
    def encrypted(self) -> bool:
        """Whether the connection is TLS."""
        return self.tls or self.authority is not None

    @property
    def broker_port(self) -> int:
        """The broker's port: MQTT's own where none is set."""
        if self.port is not None:
            return self.port
        return TLS_PORT if self.encrypted else PLAIN_PORT

    def password(self) -> str | None:
        """Read the password; raises SettingsError."""
        if self.password_file is None:
            return None
        try:
            return self.password_file.read_text(encoding="utf-8").strip()
        except (OSError, UnicodeDecodeError) as error:
            reason = error.strerror if isinstance(error, OSError) else "it is no text"
            raise SettingsError(f"cannot read {self.password_file}: {reason}") from None

    def tls_context(self) -> ssl.SSLContext | None:
        """Make what checks the broker's certificate and name; raises SettingsError."""
        if not self.encrypted:
            return None
        try:
            return ssl.create_default_context(cafile=self.authority)
        except (OSError, ssl.SSLError) as error:
            reason = "it holds no certificate (PEM)" if isinstance(error, ssl.SSLError) else error
            raise SettingsError(f"cannot use {self.authority}: {reason}") from None


def check_homeassistant(settings: HomeAssistantSettings) -> None:
    """Check all that can be known without the broker.

    Raises SettingsError, and ModuleNotFoundError where the extra is not installed.
    """
    import aiomqtt  # noqa: F401

    for file in (settings.password_file, settings.authority):
        if file is not None and is_credential(file):
            return  # it is there only while the service runs
    settings.password()
    settings.tls_context()

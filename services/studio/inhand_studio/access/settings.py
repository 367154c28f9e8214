"""What a settings file says of who may reach the studio."""

from typing import Self

from inhand_runtime.settings import FilePath, Section
from pydantic import Field, SecretStr, model_validator

from inhand_studio.access.parameters import DEFAULT_GATE


class AccessSettings(Section):
    """Where the studio listens, and who may reach it.

    On an address that other machines reach a password is needed, in a file or in the environment.
    ``names`` are the host names under which browsers call a studio: those of this machine alone
    are known without a word. ``certificate`` and ``private_key`` (PEM) make it HTTPS.
    """

    host: str = Field(default="127.0.0.1", min_length=1)
    port: int = Field(default=8730, ge=0, le=65535)
    names: tuple[str, ...] = ()
    password: SecretStr | None = Field(
        default=None, min_length=DEFAULT_GATE.fewest_characters, repr=False
    )
    password_file: FilePath | None = None
    certificate: FilePath | None = None
    private_key: FilePath | None = None

    @model_validator(mode="after")
    def _pairs(self) -> Self:
        if self.password is not None and self.password_file is not None:
            raise ValueError("password and password_file exclude each other: give one of them")
        if (self.certificate is None) != (self.private_key is None):
            raise ValueError("certificate and private_key belong together: give both, or neither")
        return self

"""What a settings file says of a hub."""

from pathlib import Path
from typing import Annotated

from inhand_runtime.settings import Address, FilePath, Section
from pydantic import AfterValidator, Field

PORT = 7448
"""The port of a hub, where none is named: the next one to that at which processes meet."""
USUAL_ADDRESS = f"tls/127.0.0.1:{PORT}"


def _encrypted(address: str) -> str:
    if not address.startswith("tls/"):
        raise ValueError(f"{address!r} is not encrypted; write it as {USUAL_ADDRESS}")
    return address


class HubSettings(Section):
    """``[hub.NAME]``: the hub's ``folder``, which ``inhand hub init`` made, and where to listen.

    Without a word that is this machine alone; ``tls/0.0.0.0:7448`` is all of its addresses. Its
    A further hub of the site has the addresses of the first in ``connect``. Its
    private ``key`` may be elsewhere than in the folder, as where systemd gives it to the hub alone.
    """

    folder: FilePath = Field(default=Path("site/hub"), validate_default=True)
    key: FilePath | None = None
    listen: Annotated[
        tuple[Annotated[Address, AfterValidator(_encrypted)], ...], Field(min_length=1)
    ] = (USUAL_ADDRESS,)
    connect: tuple[Annotated[Address, AfterValidator(_encrypted)], ...] = ()

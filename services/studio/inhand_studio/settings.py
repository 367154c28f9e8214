"""What a settings file says of a studio."""

from pathlib import Path

from inhand_runtime.settings import FilePath
from pydantic import Field

from inhand_studio.access.settings import AccessSettings


class StudioSettings(AccessSettings):
    """``[studio.NAME]``: the ``dataset`` that pages show and write, and who may reach them.

    What is said of who may reach them stands in ``AccessSettings``.
    """

    dataset: FilePath = Field(default=Path("dataset"), validate_default=True)

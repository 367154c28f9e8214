"""What a settings file says of a studio."""

from pathlib import Path

from inhand_runtime.settings import FilePath, Section
from pydantic import Field


class StudioSettings(Section):
    """``[studio.NAME]``: the pages of a rig, and the dataset that they show and write."""

    dataset: FilePath = Field(default=Path("dataset"), validate_default=True)
    host: str = "127.0.0.1"
    port: int = Field(default=8730, ge=0, le=65535)

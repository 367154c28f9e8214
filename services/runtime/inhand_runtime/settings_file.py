"""The content of a settings file as values, before anything of it is checked."""

import codecs
import tomllib
from pathlib import Path
from typing import Any

from inhand_runtime.accepted_settings import accepted_data
from inhand_runtime.errors import SettingsError
from inhand_runtime.settings_errors import ENCODING

UTF_16_MARKS = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)


def read_values(path: Path) -> dict[str, Any]:
    """Read a file's values as they stand there, unchecked; raises SettingsError.

    A process that is supervised reads them as its supervisor accepted them.
    """
    data = accepted_data(path)
    return values_in(settings_data(path) if data is None else data, path)


def settings_data(path: Path) -> bytes:
    """Read the content of a file; raises SettingsError, also for a pipe, which may never end."""
    try:
        if path.is_fifo():
            raise SettingsError(f"{path} is a pipe: name a file")
        return path.read_bytes()
    except OSError as error:
        raise SettingsError(f"cannot read {path}: {error.strerror}") from None


def values_in(data: bytes, path: Path) -> dict[str, Any]:
    """Read the values of a file's content, unchecked; raises SettingsError that names ``path``."""
    try:
        return tomllib.loads(data.decode(ENCODING))
    except UnicodeDecodeError as error:
        if b"\0" in error.object and not error.object.startswith(UTF_16_MARKS):
            raise SettingsError(f"{path} is no text: name the rig's settings (TOML)") from None
        raise SettingsError(f"{path} is no UTF-8 text: save it as UTF-8") from None
    except tomllib.TOMLDecodeError as error:
        raise SettingsError(f"{path} is no TOML: {error}") from None

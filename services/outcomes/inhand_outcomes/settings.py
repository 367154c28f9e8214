"""What a settings file says of outcomes."""

from typing import Annotated

from inhand_runtime.errors import SettingsError
from inhand_runtime.settings import FilePath, Section, Settings
from inhand_runtime.settings_errors import suggestion
from inhand_runtime.writable import try_folder
from inhand_schemas.fields import Name, Vector3
from pydantic import AfterValidator

from inhand_outcomes.homeassistant.settings import HomeAssistantSettings, check_homeassistant
from inhand_outcomes.keeping import KeepingSettings
from inhand_outcomes.uses import USES


def _known_use(name: str | None) -> str | None:
    if name is not None and name not in USES:
        raise ValueError(f"no use {name!r}" + suggestion(name, USES))
    return name


class ObjectUse(Section):
    """``[outcomes.NAME.objects.OBJECT]``: how an object is used, where its model does not say so,
    and points of it in its own frame, metres, where its mesh does not show them."""

    use: Annotated[str | None, AfterValidator(_known_use)] = None
    parts: dict[Name, Vector3] = {}


class OutcomesSettings(KeepingSettings):
    """``[outcomes.NAME]``: what is measured, beside what is kept of it.

    Measured are the objects of ``models``; without any, those that trackers of the same file
    follow. Those of ``always_in_use`` count though their tracker has no recogniser, which would
    tell when they are used. ``homeassistant`` shows it in Home Assistant.
    """

    models: tuple[FilePath, ...] = ()
    objects: dict[Name, ObjectUse] = {}
    always_in_use: tuple[Name, ...] = ()
    homeassistant: HomeAssistantSettings | None = None


def check(settings: Settings[OutcomesSettings]) -> None:
    """Check all that can be known before a start.

    Raises SettingsError, and ModuleNotFoundError where an extra is missing.
    """
    if settings.service.homeassistant is not None:
        check_homeassistant(settings.service.homeassistant)
    file = settings.service.database_file
    if file is None:
        return
    try:
        try_folder(file.parent)
    except OSError as error:
        raise SettingsError(
            f"cannot write to {file.parent}: {error.strerror}: change database in the settings of "
            "outcomes"
        ) from None

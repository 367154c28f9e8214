"""What a settings file says of outcomes."""

from typing import Annotated, Self

from inhand_runtime.errors import SettingsError
from inhand_runtime.settings import FilePath, Section, Settings
from inhand_runtime.settings_errors import suggestion
from inhand_runtime.writable import try_folder
from inhand_schemas.fields import Name
from pydantic import AfterValidator, Field, model_validator

from inhand_outcomes.homeassistant.settings import HomeAssistantSettings, check_homeassistant
from inhand_outcomes.keeping import KeepingSettings
from inhand_outcomes.uses import USES


def _known_use(name: str | None) -> str | None:
    if name is not None and name not in USES:
        raise ValueError(f"no use {name!r}" + suggestion(name, USES))
    return name


Metres = Annotated[float, Field(allow_inf_nan=False)]
Point = tuple[Metres, Metres, Metres]


class ObjectUse(Section):
    """``[outcomes.NAME.objects.OBJECT]``: how an object is used, where its model does not say so,
    and points of it in its own frame, metres, where its mesh does not show them."""

    use: Annotated[str | None, AfterValidator(_known_use)] = None
    parts: dict[str, Point] = {}

    @model_validator(mode="after")
    def _fits(self) -> Self:
        uses = USES.values() if self.use is None else (USES[self.use],)
        known = sorted({part for use in uses for part in use.parts})
        for name in self.parts:
            if not known:
                raise ValueError(f"{self.use} goes by no parts: leave {name} out")
            if name not in known:
                raise ValueError(f"there is no part {name!r}" + suggestion(name, known))
        return self


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

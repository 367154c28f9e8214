"""The settings of what is kept, for how long, of whom, and towards which goals."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Self
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

from inhand_runtime.errors import SettingsError
from inhand_runtime.private_file import PRIVATE_FILE
from inhand_runtime.settings import FilePath, Section
from inhand_runtime.settings_errors import suggestion
from pydantic import AfterValidator, Field, ValidationInfo, model_validator

from inhand_outcomes.regions import Region
from inhand_outcomes.rules import (
    MOST_PERSON,
    Goal,
    PersonNumber,
    PersonsGoal,
    QuietHours,
    Rules,
)
from inhand_outcomes.store.database import Database, open_database, readable_address
from inhand_outcomes.store.failures import StoreError
from inhand_outcomes.store.retention import Retention
from inhand_outcomes.store.saving import Keeping, Kept

POSTGRESQL = "postgresql+psycopg://"
LOCAL_TIME = Path("/etc/localtime")


def _database(text: str, info: ValidationInfo) -> str:
    if not text:
        raise ValueError("name a file, or an address postgresql+psycopg://USER@HOST/DATABASE")
    if "://" not in text:
        folder = info.context["folder"] if info.context else Path()
        return str(folder / text)
    if not text.startswith(POSTGRESQL):
        raise ValueError(f"write an address as {POSTGRESQL}USER@HOST/DATABASE, or name a file")
    user = text.removeprefix(POSTGRESQL).partition("/")[0].rpartition("@")[0]
    if ":" in user or "password=" in text:
        raise ValueError("leave the password out: write it to a file, and name it password_file")
    if not readable_address(text):
        raise ValueError(f"it is no address: write it as {POSTGRESQL}USER@HOST/DATABASE")
    return text


def _zone(name: str) -> str:
    try:
        ZoneInfo(name)
    except (ZoneInfoNotFoundError, ValueError, OSError):
        raise ValueError(f"there is no time zone {name!r}: write it as Europe/Zurich") from None
    return name


def host_time_zone() -> str:
    """Return the name of the time zone that this host is set to, UTC where none can be read."""
    _, _, name = str(LOCAL_TIME.resolve()).partition("/zoneinfo/")
    try:
        return _zone(name)
    except ValueError:
        return "UTC"


class KeepingSettings(Section):
    """What ``[outcomes.NAME]`` says of keeping.

    ``database`` is a file of SQLite, or the address of PostgreSQL with its password in
    ``password_file``. Days are local ones of ``time_zone``, the host's unless said. Outcomes are
    counted from the probability ``sure`` on. Details are kept for ``keep_days``, with the kinds of
    evidence that ``keep`` names, and the totals of days for ``keep_totals_days``; 0 is for ever.
    ``people`` are names of the numbers that people have, ``goals`` what is to be reached,
    ``quiet`` the hours without reminders, and ``regions`` named parts of the floor.
    """

    database: Annotated[str, AfterValidator(_database)] = Field(
        default="outcomes.db", validate_default=True
    )
    password_file: FilePath | None = None
    time_zone: Annotated[str, AfterValidator(_zone)] = Field(default_factory=host_time_zone)
    sure: Annotated[float, Field(ge=0, le=1)] = 0.5
    keep: frozenset[Kept] = frozenset({"numbers", "poses"})
    keep_days: Annotated[int, Field(ge=0)] = 400
    keep_totals_days: Annotated[int, Field(ge=0)] = 0
    people: Mapping[PersonNumber, Annotated[str, Field(min_length=1)]] = {}
    goals: tuple[Goal, ...] = ()
    quiet: QuietHours | None = None
    regions: tuple[Region, ...] = ()

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if 0 < self.keep_totals_days < self.keep_days or (
            self.keep_totals_days and not self.keep_days
        ):
            raise ValueError("keep_totals_days must be keep_days at least: details have totals")
        if len(set(self.people.values())) < len(self.people):
            raise ValueError("people: two have one name")
        if not all(name.isprintable() and name.strip() for name in self.people.values()):
            raise ValueError("people: write names in letters that can be shown")
        if any(name.isdecimal() for name in self.people.values()):
            raise ValueError("people: a name of digits alone would be another's number")
        names = [goal.name for goal in self.goals]
        if len(set(names)) < len(names):
            raise ValueError("goals: two have one name")
        names = [region.name for region in self.regions]
        if len(set(names)) < len(names):
            raise ValueError("regions: two have one name")
        for goal in self.goals:
            if isinstance(goal.person, str):
                person_number(goal.person, self.people)
            for at in goal.remind_at:
                if self.quiet is not None and self.quiet.hold(at):
                    raise ValueError(f"goals: {goal.name} reminds at {at:%H:%M}, in quiet hours")
        return self

    @property
    def zone(self) -> ZoneInfo:
        """The time zone of days."""
        return ZoneInfo(self.time_zone)

    @property
    def keeping(self) -> Keeping:
        """How outcomes are kept."""
        return Keeping(self.zone, self.sure, self.keep)

    @property
    def retention(self) -> Retention:
        """For how long."""
        return Retention(self.keep_days, self.keep_totals_days)

    @property
    def rules(self) -> Rules:
        """The goals of whom they are."""
        goals = [PersonsGoal(goal, _goals_person(goal, self.people)) for goal in self.goals]
        return Rules(goals, self.zone, self.quiet)

    @property
    def database_file(self) -> Path | None:
        """The file of SQLite, None for PostgreSQL."""
        return None if self.database.startswith(POSTGRESQL) else Path(self.database)


def _goals_person(goal: Goal, people: Mapping[int, str]) -> int | None:
    return person_number(goal.person, people) if isinstance(goal.person, str) else goal.person


def person_number(text: str, people: Mapping[int, str]) -> int:
    """Return the number of a person, who is named by it or by ``people``; raises ValueError."""
    if text.isdecimal():
        if int(text) > MOST_PERSON:
            raise ValueError(f"nobody has the number {text}: it is beyond {MOST_PERSON}")
        return int(text)
    for number, name in people.items():
        if name == text:
            return number
    if not people:
        raise ValueError(f"nobody is named {text!r}: use a number, or name people in the settings")
    raise ValueError(f"nobody is named {text!r}" + suggestion(text, people.values()))


def open_kept(settings: KeepingSettings, owner: str | None = None) -> Database:
    """Open the database that the settings name, as its ``owner`` or to look at it; a file is made
    with its folder where there is none, for this user alone. Raises StoreError, and SettingsError
    where the password cannot be read."""
    file = settings.database_file
    if file is not None:
        try:
            if not file.exists():
                file.parent.mkdir(parents=True, exist_ok=True)
                file.touch(PRIVATE_FILE)
        except OSError as error:
            raise StoreError(f"the database {file} cannot be made: {error.strerror}") from None
        return open_database(file, owner=owner)
    password = None
    if settings.password_file is not None:
        try:
            password = settings.password_file.read_text(encoding="utf-8").strip()
        except (OSError, UnicodeDecodeError) as error:
            reason = error.strerror if isinstance(error, OSError) else "it is no text"
            raise SettingsError(f"cannot read {settings.password_file}: {reason}") from None
    return open_database(settings.database, password, owner=owner)

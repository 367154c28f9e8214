"""Settings of what is kept are checked before anything is kept."""

from pathlib import Path
from typing import Any

import pytest
from inhand_outcomes.keeping import KeepingSettings, open_kept, person_number
from inhand_outcomes.rules import QuietHours
from inhand_runtime.errors import SettingsError
from pydantic import ValidationError

DRINK = {"name": "drink", "kind": "sip", "at_least": 8}
HALL = {"name": "hall", "from": [1.0, 2.0], "to": [2.0, 3.0]}
PEOPLE = {"0": "anna", "1": "ben"}


@pytest.mark.parametrize(
    ("settings", "line"),
    [
        ({"time_zone": "Europe/Zürich"}, "there is no time zone 'Europe/Zürich'"),
        ({"time_zone": "/etc/passwd"}, "there is no time zone"),
        ({"database": "mysql://home"}, "write an address as postgresql"),
        ({"database": "postgresql+psycopg://me:secret@host/home"}, "leave the password out"),
        ({"database": ""}, "name a file"),
        ({"database": "postgresql+psycopg://me@host:x/home"}, "it is no address"),
        ({"sure": 1.1}, "less than or equal to 1"),
        ({"keep": ["images"]}, "'numbers' or 'poses'"),
        ({"keep_days": 90, "keep_totals_days": 30}, "keep_days at least"),
        ({"keep_days": 0, "keep_totals_days": 30}, "keep_days at least"),
        ({"people": {"0": "anna", "1": "anna"}}, "two have one name"),
        ({"people": {"0": "1"}}, "another's number"),
        ({"people": {"0": "an\x1b[2Jna"}}, "letters that can be shown"),
        ({"people": {"0": " "}}, "letters that can be shown"),
        ({"goals": [DRINK, DRINK]}, "two have one name"),
        ({"people": PEOPLE, "goals": [{**DRINK, "person": "bne"}]}, r"did you mean ben\?"),
        ({"goals": [{**DRINK, "person": "ben"}]}, "or name people in the settings"),
        ({"goals": [{**DRINK, "kind": "sipp"}]}, r"no kind 'sipp' \(did you mean sip\?\)"),
        (
            {"goals": [{**DRINK, "amount": "volume_l"}]},
            r"a sip has no amount 'volume_l' \(did you mean volume_ml\?\)",
        ),
        ({"goals": [{**DRINK, "amount": "speed_m_s"}]}, "a sip has no amount 'speed_m_s'"),
        ({"goals": [{**DRINK, "object": "tea pot"}]}, "object 'tea pot' is no name"),
        ({"goals": [{**DRINK, "person": -1}]}, "greater than or equal to 0"),
        ({"goals": [{**DRINK, "amount": "days", "per": "week"}]}, "8 days, and a week has 7"),
        ({"people": {str(2**63): "anna"}}, "less than or equal to"),
        ({"regions": [HALL, HALL]}, "two have one name"),
        ({"regions": [{**HALL, "to": [1.0, 3.0]}]}, "hall has no area"),
        ({"regions": [{**HALL, "to": [9.0, 3.0]}]}, "less than or equal to 6"),
        ({"quiet": {"from": "07:00", "to": "07:00"}}, "leave quiet out"),
        (
            {
                "quiet": {"from": "22:00", "to": "07:00"},
                "goals": [{**DRINK, "remind_at": ["23:00"]}],
            },
            "drink reminds at 23:00, in quiet hours",
        ),
    ],
)
def test_what_cannot_be_meant_is_refused(settings: dict[str, Any], line: str) -> None:
    with pytest.raises(ValidationError, match=line):
        KeepingSettings.model_validate(settings)


def test_a_goal_is_of_the_person_whom_it_names() -> None:
    goals = [{**DRINK, "name": name, "person": person} for name, person in (("a", "ben"), ("b", 0))]
    settings = KeepingSettings.model_validate({"people": PEOPLE, "goals": goals})
    assert [one.person for one in settings.rules.goals] == [1, 0]
    assert person_number("7", settings.people) == 7


def test_a_number_that_no_person_can_have_is_refused() -> None:
    with pytest.raises(ValueError, match="nobody has the number 9223372036854775808"):
        person_number(str(2**63), {})


def test_quiet_hours_that_do_not_pass_midnight_are_by_day() -> None:
    quiet = QuietHours.model_validate({"from": "12:00", "to": "14:00"})
    times = {name: getattr(quiet, name) for name in ("begin", "end")}
    assert quiet.hold(times["begin"])
    assert not quiet.hold(times["end"])
    assert quiet.share_before(times["end"]) == 0.0
    assert quiet.share_before(times["begin"]) == 1.0


def test_a_relative_file_is_beside_the_settings(tmp_path: Path) -> None:
    settings = KeepingSettings.model_validate({}, context={"folder": tmp_path})
    assert settings.database_file == tmp_path / "outcomes.db"


def test_a_password_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    address = "postgresql+psycopg://me@localhost/home"
    settings = KeepingSettings(database=address, password_file=tmp_path / "none")
    with pytest.raises(SettingsError, match=r"cannot read .*none: No such file"):
        open_kept(settings)

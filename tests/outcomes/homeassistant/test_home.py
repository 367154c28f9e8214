"""What is handed over of what is kept, and what stays over restarts."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from datetime import date
from pathlib import Path
from zoneinfo import ZoneInfo

import numpy as np
import pytest
from inhand_outcomes.achievement import Amount
from inhand_outcomes.homeassistant.home import Home, Place
from inhand_outcomes.homeassistant.settings import HomeAssistantSettings
from inhand_outcomes.homeassistant.state import HomeState
from inhand_outcomes.outcome import Outcome
from inhand_outcomes.pausing import Pausing
from inhand_outcomes.regions import Region
from inhand_outcomes.rules import Goal, PersonsGoal, Rules
from inhand_outcomes.store.database import Database, open_database
from inhand_outcomes.store.floor_maps import FloorMapHeader, KeptFloorMap, keep_floor_map
from inhand_outcomes.store.forgetting import Forget, forget
from inhand_outcomes.store.saving import Keeping, Saver
from inhand_schemas.messages import Pose

NOW_NS = 1_796_000_000_000_000_000
ZURICH = ZoneInfo("Europe/Zurich")
GOAL = Goal(name="drink", kind="sip", amount="volume_ml", at_least=60)
SETTINGS = HomeAssistantSettings(host="broker")
SIP = Outcome(
    id="1",
    kind="sip",
    object="mug",
    person=0,
    start_ns=NOW_NS - 3 * 10**9,
    end_ns=NOW_NS - 10**9,
    probability=0.9,
    amounts={"volume_ml": Amount(31.0, 4.0)},
    evidence={},
    rig_from_object=Pose((0.1, 0.2, 1.5), (1.0, 0.0, 0.0, 0.0)),
)


@pytest.fixture
def database(tmp_path: Path) -> Iterator[Database]:
    opened = open_database(tmp_path / "outcomes.db")
    yield opened
    opened.close()


def a_home(regions: Sequence[Region] = (), **uses: str) -> Home:
    rules = Rules([PersonsGoal(GOAL, None)], ZURICH)
    place = Place("inhand", "rig", "home")
    return Home(SETTINGS, place, uses or {"mug": "drinking"}, rules, 0.5, Pausing(), regions)


def keep(database: Database, *outcomes: Outcome) -> None:
    Saver(database, Keeping(ZURICH)).save(outcomes)


def shown(home: Home, database: Database, now_ns: int = NOW_NS) -> HomeState:
    home.show(database, now_ns)
    newest = home.handover.newest()
    assert newest is not None
    return newest[0]


def test_totals_are_of_all_people_and_of_what_counts(database: Database) -> None:
    other = replace(SIP, id="2", person=1, amounts={"volume_ml": Amount(33.0, 3.0)})
    keep(database, SIP, other, replace(SIP, id="3", person=2, probability=0.2))
    state = shown(a_home(), database)
    total = state.totals["mug", "sip"]
    assert (total.times, total.amounts["volume_ml"].sum) == (2, 64.0)
    assert state.goals["drink"].reached
    assert state.places["mug"].rig_from_object == SIP.rig_from_object
    tomorrow = shown(a_home(), database, NOW_NS + 86_400 * 10**9)
    assert (tomorrow.totals, tomorrow.goals["drink"].reached) == ({}, False)
    assert tomorrow.since.date() == date(2026, 12, 1)


@pytest.mark.parametrize(
    ("kinds", "in_use"),
    [
        ((), None),
        (("taken_up",), True),
        (("taken_up", "sip"), True),
        (("taken_up", "put_down"), False),
        (("taken_up", "left_in_use"), None),
        (("put_down", "handed_over"), True),
    ],
)
def test_what_is_in_use_is_by_what_was_done_last_also_after_a_restart(
    database: Database, kinds: tuple[str, ...], in_use: bool | None
) -> None:
    done = [
        replace(
            SIP, id=str(at), kind=kind, start_ns=NOW_NS + at * 10**9, end_ns=NOW_NS + at * 10**9
        )
        for at, kind in enumerate(kinds)
    ]
    home = a_home()
    home.say(done)
    keep(database, *done)
    for one in (home, a_home()):
        assert shown(one, database).in_use.get("mug") is in_use


def test_only_what_is_sure_is_an_event(database: Database) -> None:
    home = a_home()
    home.say([SIP, replace(SIP, id="2", probability=0.4)])
    (event,) = home.handover.take_events()
    assert (event.kind, event.object) == ("sip", "mug")
    assert event.numbers == {"probability": 0.9, "volume_ml": 31.0}


def test_what_was_announced_is_removed_with_its_object_also_after_a_restart(
    database: Database,
) -> None:
    before = shown(a_home(mug="drinking", broom="sweeping"), database).shape
    home = a_home()
    state = shown(home, database)
    assert [one.name for one in state.shape.objects] == ["mug"]
    assert home.handover.newest() == (state, (before,))
    home.handover.announce(state.shape)
    shown(home, database)
    assert home.handover.newest() == (state, ())
    shown(a_home(), database)
    assert a_home().handover.newest() is None


def test_the_device_is_the_same_whatever_the_rig_is_called_later(database: Database) -> None:
    node = shown(a_home(), database).shape.node
    rules = Rules([], ZURICH)
    renamed = Home(
        SETTINGS, Place("inhand", "kitchen", "house"), {"mug": ""}, rules, 0.5, Pausing()
    )
    state = shown(renamed, database)
    assert (state.shape.node, state.shape.label) == (node, "Inhand house")


def test_an_entity_stays_when_its_outcomes_are_forgotten(database: Database) -> None:
    stirring = replace(SIP, kind="stirring", amounts={"duration_s": Amount(4.0, 0.1)})
    keep(database, stirring)
    home = a_home()
    shape = shown(home, database).shape
    assert ("stirring", ("duration_s",)) in shape.objects[0].kinds
    forget(database, Forget(day=date(2026, 11, 30)), NOW_NS)
    home.look_anew()
    assert shown(home, database).shape == shape
    assert shown(a_home(), database).shape == shape


def test_the_floor_is_shown_where_something_is_swept(database: Database) -> None:
    hall = Region.model_validate({"name": "hall", "from": [-1.0, 0.5], "to": [1.0, 2.5]})
    home = a_home(broom="sweeping", regions=[hall])
    before = shown(home, database)
    assert before.regions["hall"].share == 0.0
    assert before.floor_png.startswith(b"\x89PNG")
    header = FloorMapHeader(cell_m=0.05, x_m=-1.0, y_m=0.5, rows=40, columns=40)
    cells = np.full((40, 40), 0x20, np.uint8)
    cells[:20] |= 0x1F  # swept
    keep_floor_map(database, KeptFloorMap(date(2026, 11, 30), "broom", 0, header, cells))
    home.look_anew()
    after = shown(home, database)
    assert after.floor_png not in (before.floor_png, b"")
    assert after.shape.regions == ("hall",)
    assert after.regions["hall"].share == pytest.approx(0.5)
    assert after.regions["hall"].missed_m2 == pytest.approx(2.0)

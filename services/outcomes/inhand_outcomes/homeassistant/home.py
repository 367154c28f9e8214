"""The daemon's side of Home Assistant: makes states out of what is kept, and hands them over."""

import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from datetime import date, datetime
from datetime import time as clock_time
from hashlib import blake2b

import msgspec
from inhand_schemas.messages import Event

from inhand_outcomes.days import first_day, local_day, local_time
from inhand_outcomes.floor_map import RegionShare
from inhand_outcomes.handling import DROPPED, LEFT_IN_USE, PUT_DOWN
from inhand_outcomes.homeassistant.handover import Handover
from inhand_outcomes.homeassistant.parameters import DEFAULT_HOME, HomeParameters
from inhand_outcomes.homeassistant.settings import HomeAssistantSettings
from inhand_outcomes.homeassistant.shape import Shape, goal_shape, new_node, object_shape
from inhand_outcomes.homeassistant.state import GoalProgress, HomeEvent, HomeState, KindTotal
from inhand_outcomes.outcome import Outcome
from inhand_outcomes.pausing import Pausing
from inhand_outcomes.regions import Region, shares_of
from inhand_outcomes.rules import PersonsGoal, Rules, progress
from inhand_outcomes.store.database import Database
from inhand_outcomes.store.floor_maps import KeptFloorMap, floor_maps
from inhand_outcomes.store.queries import days_kept, last_places, latest, totals
from inhand_outcomes.store.saving import STANDING, read_journal, write_journal
from inhand_outcomes.totals import AmountTotal, DayTotal

NODE, SHAPES = (f"{STANDING}homeassistant/{name}" for name in ("node", "shapes"))
"""Entries of the journal: the device's id, and all shapes of which something may be retained by the
broker."""
SWEPT = "sweeping"
NOT_IN_USE = (PUT_DOWN, DROPPED)
LAST_OUTCOMES = 50
"""Number of an object's outcomes that are looked at for whether it is in use at a start."""


@dataclass(frozen=True)
class Place:
    """Which daemon it is."""

    realm: str
    rig: str
    instance: str


class Home:
    """Shows Home Assistant what a database keeps. All is called from the daemon's loop."""

    def __init__(
        self,
        settings: HomeAssistantSettings,
        place: Place,
        uses: Mapping[str, str],
        rules: Rules,
        sure: float,
        pausing: Pausing,
        regions: Sequence[Region] = (),
        parameters: HomeParameters = DEFAULT_HOME,
    ) -> None:
        """``uses`` are those of the objects by name, ``sure`` the probability from which an outcome
        counts, and ``regions`` parts of the floor."""
        self.handover = Handover(parameters)
        self.pausing = pausing
        self._settings = settings
        self._place = place
        self._uses = uses
        self._rules = rules
        self._sure = sure
        self._regions = regions
        self._parameters = parameters
        self._node = ""
        self._old: tuple[Shape, ...] = ()
        self._shape: Shape | None = None
        self._last_use: dict[str, tuple[int, bool | None]] = {}
        self._floor = (b"", b"")
        self._next_look_s = float("-inf")

    def say(self, outcomes: Iterable[Outcome]) -> None:
        """Say what is new of objects: what is too uncertain to count is passed over."""
        sure = [one for one in outcomes if one.probability >= self._sure]
        for outcome in sure:
            self._note_use(outcome)
        self._say(self._event(outcome.message(0)) for outcome in sure)

    def say_goals(self, events: Iterable[Event]) -> None:
        """Say what is new of goals."""
        self._say(self._event(event, goal=event.description) for event in events)

    def look_anew(self) -> None:
        """Look again at what is kept: something was forgotten, or is measured no more or again."""
        self._last_use.clear()
        self._look_soon()

    def show(self, database: Database, now_ns: int) -> None:
        """Hand over what is kept, if it may have changed; raises StoreError."""
        self.recall(database)
        announced = self.handover.take_announced()
        if announced is not None and self._old != (announced,) and announced == self._shape:
            self._keep_shapes(database, (announced,))
            self._look_soon()
        if time.monotonic() < self._next_look_s:
            return
        state = self._state(database, now_ns)
        if state.shape not in self._old:
            self._keep_shapes(database, (*self._old, state.shape))
        self._shape = state.shape
        self.handover.show(state, tuple(one for one in self._old if one != state.shape))
        self._next_look_s = time.monotonic() + self._parameters.refresh_s

    def _look_soon(self) -> None:
        self._next_look_s = float("-inf")

    def _say(self, events: Iterable[HomeEvent]) -> None:
        new = list(events)
        if new:
            self._look_soon()
            self.handover.say(new)

    def recall(self, database: Database) -> None:
        """Go on where the last process of this database ended, once; raises StoreError."""
        if self._node:
            return
        entries = read_journal(database)
        place = self._place
        node = entries.get(NODE, b"").decode() or new_node(place.realm, place.rig, place.instance)
        if NODE not in entries:
            write_journal(database, {NODE: node.encode()})
        self._old = msgspec.msgpack.decode(entries.get(SHAPES, b"\x90"), type=tuple[Shape, ...])
        for name in self._uses:
            for kept in reversed(latest(database, LAST_OUTCOMES, object_name=name)):
                if kept.counted:
                    self._note_use(kept.outcome)
        self._node = node

    def _keep_shapes(self, database: Database, shapes: tuple[Shape, ...]) -> None:
        write_journal(database, {SHAPES: msgspec.msgpack.encode(shapes)})
        self._old = shapes

    def _note_use(self, outcome: Outcome) -> None:
        """Note whether an object is in use after an outcome of it."""
        last_ns, _ = self._last_use.get(outcome.object, (0, None))
        if outcome.end_ns >= last_ns:
            in_use = None if outcome.kind == LEFT_IN_USE else outcome.kind not in NOT_IN_USE
            self._last_use[outcome.object] = (outcome.end_ns, in_use)

    def _event(self, event: Event, goal: str | None = None) -> HomeEvent:
        return HomeEvent(
            event.kind,
            local_time(event.time_ns, self._rules.zone),
            event.object,
            goal,
            {"probability": event.probability or 0.0, **event.amounts},
        )

    def _state(self, database: Database, now_ns: int) -> HomeState:
        today = local_day(now_ns, self._rules.zone)
        kept = days_kept(database)
        seen = totals(database, first_day(today, "week"), today)
        if self._shape is None and kept is not None:
            seen = totals(database, *kept)
        maps = floor_maps(database, today)
        counted = [one for one in seen if one.counted]
        return HomeState(
            shape=self._shape_of(counted, floor=bool(maps)),
            since=self._beginning(today),
            totals=_by_kind(one for one in counted if one.day == today),
            places={one.object: one for one in last_places(database, self._uses)},
            in_use={name: in_use for name, (_, in_use) in self._last_use.items()},
            goals={one.goal.name: self._progress(one, counted, today) for one in self._rules.goals},
            floor_png=self._floor_png(maps),
            zone=self._rules.zone,
            paused=self.pausing.paused,
            regions=self._shares(maps),
        )

    def _shape_of(self, seen: Sequence[DayTotal], *, floor: bool) -> Shape:
        last = self._old[-1] if self._old else None
        before = {one.name: one for one in last.objects} if last is not None else {}
        return Shape(
            node=self._node,
            label=f"Inhand {self._place.instance}",
            prefix=self._settings.discovery_prefix,
            single_components=self._settings.single_components,
            objects=tuple(
                object_shape(name, use, seen, before.get(name))
                for name, use in sorted(self._uses.items())
            ),
            goals=tuple(goal_shape(one.goal) for one in self._rules.goals),
            floor=floor or SWEPT in self._uses.values(),
            regions=tuple(one.name for one in self._regions),
        )

    def _progress(
        self, goal: PersonsGoal, counted: Sequence[DayTotal], today: date
    ) -> GoalProgress:
        first = first_day(today, goal.goal.per)
        value = progress(goal, counted, first)
        wanted = goal.goal.wanted
        enough = value >= wanted if goal.goal.at_least is not None else value <= wanted
        return GoalProgress(value, wanted, enough, self._beginning(first))

    def _beginning(self, day: date) -> datetime:
        """The first moment of a local day."""
        return datetime.combine(day, clock_time.min, self._rules.zone)

    def _shares(self, maps: Sequence[KeptFloorMap]) -> dict[str, RegionShare]:
        """How much of each region was swept."""
        if not self._regions:
            return {}
        try:
            return shares_of(maps, self._regions)
        except ValueError:  # as the picture
            return shares_of(maps[-1:], self._regions)

    def _floor_png(self, maps: Sequence[KeptFloorMap]) -> bytes:
        """The picture of the floor, drawn anew where the maps are others; empty where nothing is
        ever swept."""
        if not maps and SWEPT not in self._uses.values():
            return b""
        # OpenCV takes 17 MB, which only homes with a broom pay.
        from inhand_outcomes.kept_floor_picture import kept_floor_png, unswept_png

        digest = blake2b()
        for one in maps:
            digest.update(repr((one.day, one.header)).encode() + one.cells.tobytes())
        if self._floor[0] != digest.digest():
            try:
                picture = kept_floor_png(maps, self._regions) if maps else unswept_png()
            except ValueError:  # a rig that was moved on that day: the newer one's
                picture = kept_floor_png(maps[-1:], self._regions)
            self._floor = (digest.digest(), picture)
        return self._floor[1]


def _by_kind(counted: Iterable[DayTotal]) -> dict[tuple[str, str], KindTotal]:
    """Totals of all people, by object and kind."""
    found: dict[tuple[str, str], KindTotal] = {}
    for one in counted:
        before = found.get((one.object, one.kind), KindTotal())
        amounts: dict[str, AmountTotal] = dict(before.amounts)
        for name, amount in one.amounts.items():
            amounts[name] = amounts[name] + amount if name in amounts else amount
        found[one.object, one.kind] = KindTotal(before.times + one.times, amounts)
    return found

"""What Home Assistant is to show at one moment."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from zoneinfo import ZoneInfo

from inhand_outcomes.floor_map import RegionShare
from inhand_outcomes.homeassistant.shape import Shape
from inhand_outcomes.store.queries import LastPlace
from inhand_outcomes.totals import AmountTotal


@dataclass(frozen=True)
class KindTotal:
    """What was done today of one kind with one object, by all people."""

    times: int = 0
    amounts: Mapping[str, AmountTotal] = field(default_factory=dict)


@dataclass(frozen=True)
class GoalProgress:
    """How much of a goal is done since ``since``, of how much that is ``wanted``."""

    value: float
    wanted: float
    reached: bool
    since: datetime


@dataclass(frozen=True)
class HomeState:
    """All values at once, immutable: totals by object and kind, where objects were last, whether
    each is in use (None where that is not known), goals by name, the floor's map (PNG), and how
    much of its regions was swept today, by name.

    ``since`` is the local beginning of the day of the totals.
    """

    shape: Shape
    since: datetime
    totals: Mapping[tuple[str, str], KindTotal]
    places: Mapping[str, LastPlace]
    in_use: Mapping[str, bool | None]
    goals: Mapping[str, GoalProgress]
    floor_png: bytes
    zone: ZoneInfo
    paused: bool
    regions: Mapping[str, RegionShare] = field(default_factory=dict)


@dataclass(frozen=True)
class HomeEvent:
    """Something that happened once: of an object, or of a goal where ``goal`` is its name."""

    kind: str
    time: datetime
    object: str | None
    goal: str | None
    numbers: Mapping[str, float]

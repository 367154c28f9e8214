"""One thing that somebody achieved, with how sure that is."""

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Amount:
    """How much: a value with its standard deviation, in the unit that the amount's name ends in."""

    value: float
    deviation: float


@dataclass(frozen=True)
class Achievement:
    """What a measure found in a track, from ``start_s`` to ``end_s``, seconds of the track's times.

    ``kind`` is a noun of the field: ``sip``, ``strike``. ``amounts`` are by names that end in their
    unit: ``volume_ml``, ``duration_s``, ``speed_m_s``, ``angle_deg``, ``area_m2``. ``evidence`` are
    the numbers by which it was judged, by name.
    ``lasting`` ones go on: what reaches the end of one track continues in the next.
    """

    kind: str
    start_s: float
    end_s: float
    probability: float
    amounts: Mapping[str, Amount] = field(default_factory=dict)
    evidence: Mapping[str, float] = field(default_factory=dict)
    lasting: bool = False

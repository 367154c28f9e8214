"""The kinds of things that a few measures make, and which measures are impossible.

``build_kind("my_mug", "mug", {"height": 9.5, "diameter": 8.0, "handle": 2.5})``: centimetres, as
people measure.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from inhand_runtime.errors import SettingsError

from inhand_lab.objects.hammer import HammerMeasures, build_hammer
from inhand_lab.objects.handled_shapes import build_box, build_mallet, build_paddle
from inhand_lab.objects.model import ObjectModel
from inhand_lab.objects.mug import MugMeasures, build_mug
from inhand_lab.objects.turned_shapes import (
    build_bottle,
    build_can,
    build_cup,
    build_cylinder,
    build_stick,
)

M_PER_CM = 0.01


@dataclass(frozen=True)
class Measure:
    """One measure of a kind: its meaning, and the least and the largest that can be, cm."""

    meaning: str
    least: float
    largest: float


@dataclass(frozen=True)
class Less:
    """A measure that must be less than another, or than a share of it."""

    measure: str
    than: str
    share: float = 1.0


@dataclass(frozen=True)
class Kind:
    """What a kind of thing is made from.

    ``build`` takes a name and the measures in metres, by the names of ``measures``.
    """

    measures: Mapping[str, Measure]
    build: Callable[..., ObjectModel]
    limits: tuple[Less, ...] = ()


def _mug(name: str, height: float, diameter: float, handle: float) -> ObjectModel:
    """A mug by what can be measured of it; the rest is in the proportions of the simulator's."""
    usual = MugMeasures()
    bar = min(usual.bar_radius, 0.2 * handle)
    return build_mug(
        name,
        MugMeasures(
            height=height,
            radius=diameter / 2.0,
            wall=min(usual.wall, 0.1 * diameter),
            handle_reach=handle - bar,
            handle_half_height=usual.handle_half_height / usual.height * height,
            bar_radius=bar,
        ),
    )


def _hammer(name: str, length: float, head: float, face: float, handle: float) -> ObjectModel:
    return build_hammer(name, HammerMeasures(length, head, face, handle))


KINDS: Mapping[str, Kind] = {
    "mug": Kind(
        {
            "height": Measure("height of the cup", 3.0, 30.0),
            "diameter": Measure("outer diameter of the cup", 3.0, 25.0),
            "handle": Measure("distance that the handle stands out from the cup", 1.0, 12.0),
        },
        _mug,
        (Less("handle", "diameter"),),
    ),
    "cup": Kind(
        {
            "height": Measure("height", 2.0, 40.0),
            "diameter": Measure("outer diameter of the rim", 2.0, 40.0),
            "foot": Measure("outer diameter of the foot", 1.0, 40.0),
        },
        build_cup,
        (Less("diameter", "foot", 4.0), Less("foot", "diameter", 2.0)),
    ),
    "bottle": Kind(
        {
            "height": Measure("height with its cap", 4.0, 60.0),
            "diameter": Measure("diameter of the body", 1.5, 40.0),
            "neck": Measure("diameter of the neck or cap", 0.5, 30.0),
            "shoulder": Measure("height at which it begins to narrow", 1.0, 55.0),
        },
        build_bottle,
        (Less("neck", "diameter"), Less("shoulder", "height")),
    ),
    "box": Kind(
        {
            "height": Measure("height", 0.3, 150.0),
            "width": Measure("width", 0.3, 150.0),
            "depth": Measure("depth", 0.3, 150.0),
        },
        build_box,
    ),
    "can": Kind(
        {
            "height": Measure("height", 1.0, 50.0),
            "diameter": Measure("diameter", 1.0, 40.0),
        },
        build_can,
    ),
    "cylinder": Kind(
        {
            "height": Measure("height", 0.3, 150.0),
            "diameter": Measure("diameter", 0.3, 60.0),
        },
        build_cylinder,
    ),
    "stick": Kind(
        {
            "length": Measure("length", 3.0, 300.0),
            "diameter": Measure("diameter", 0.3, 10.0),
        },
        build_stick,
        (Less("diameter", "length", 0.5),),
    ),
    "hammer": Kind(
        {
            "length": Measure("length from end to end", 10.0, 120.0),
            "head": Measure("length of the head, from the face to the tips of the claw", 4.0, 40.0),
            "face": Measure("diameter of the striking face", 0.8, 10.0),
            "handle": Measure("width of the handle where it is held", 1.0, 8.0),
        },
        _hammer,
        (Less("head", "length"), Less("face", "head", 0.5)),
    ),
    "mallet": Kind(
        {
            "length": Measure("length from end to end", 10.0, 120.0),
            "head": Measure("length of the head, from face to face", 3.0, 40.0),
            "face": Measure("diameter of the faces", 1.5, 25.0),
            "handle": Measure("diameter of the handle", 0.8, 8.0),
        },
        build_mallet,
        (Less("face", "length", 0.6), Less("handle", "face")),
    ),
    "paddle": Kind(
        {
            "length": Measure("length from end to end", 8.0, 200.0),
            "blade_length": Measure("length of the blade", 2.0, 100.0),
            "blade_width": Measure("width of the blade", 1.0, 60.0),
            "handle": Measure("diameter of the handle", 0.5, 8.0),
        },
        build_paddle,
        (Less("blade_length", "length"), Less("handle", "blade_width")),
    ),
}
"""The kinds by name."""

MEASURES = tuple(dict.fromkeys(name for kind in KINDS.values() for name in kind.measures))
"""Names of all measures, in the order of first mention."""


def build_kind(name: str, kind: str, measures_cm: Mapping[str, float]) -> ObjectModel:
    """Build an object of a kind from measures in centimetres; raises SettingsError."""
    require_measures(kind, measures_cm)
    metres = {key: M_PER_CM * value for key, value in measures_cm.items()}
    return KINDS[kind].build(name, **metres)


def require_measures(kind: str, measures_cm: Mapping[str, float]) -> None:
    """Raise SettingsError for a kind that is none, and for measures that it cannot have."""
    if kind not in KINDS:
        raise SettingsError(f"no kind {kind!r}; there are {', '.join(KINDS)}")
    known = KINDS[kind]
    _require_names(kind, known, measures_cm)
    for measure, value in measures_cm.items():
        _require_range(kind, measure, known.measures[measure], value)
    for limit in known.limits:
        _require_less(kind, limit, measures_cm)


def option(measure: str) -> str:
    """The option by which the command line takes a measure."""
    return f"--{measure.replace('_', '-')}"


def _require_names(kind: str, known: Kind, given: Mapping[str, float]) -> None:
    for measure in given:
        if measure not in known.measures:
            listed = ", ".join(map(option, known.measures))
            raise SettingsError(f"a {kind} has no {option(measure)}: it takes {listed}")
    missing = [measure for measure in known.measures if measure not in given]
    if missing:
        listed = ", ".join(f"{option(m)} ({known.measures[m].meaning})" for m in missing)
        raise SettingsError(f"a {kind} needs {listed}, in centimetres")


def _require_range(kind: str, name: str, measure: Measure, value: float) -> None:
    if not measure.least <= value <= measure.largest:  # also not a number
        raise SettingsError(
            f"{option(name)} {value:g}: the {measure.meaning} of a {kind} is {measure.least:g} to "
            f"{measure.largest:g} cm; measure it in centimetres"
        )


def _require_less(kind: str, limit: Less, given: Mapping[str, float]) -> None:
    if given[limit.measure] < limit.share * given[limit.than]:
        return
    times = "" if limit.share == 1.0 else f"{limit.share:g} times "
    raise SettingsError(
        f"{option(limit.measure)} {given[limit.measure]:g} of a {kind} must be less than {times}"
        f"{option(limit.than)} {given[limit.than]:g}: measure both again"
    )

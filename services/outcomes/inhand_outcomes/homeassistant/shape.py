"""What is announced to Home Assistant, apart from any value: objects, kinds, amounts and goals."""

import hashlib
from collections.abc import Iterable

import msgspec

from inhand_outcomes.kinds import amounts_by_kind
from inhand_outcomes.outcome import adds_up
from inhand_outcomes.rules import Goal
from inhand_outcomes.totals import DayTotal
from inhand_outcomes.uses import DURATION, USES


class ObjectShape(msgspec.Struct, frozen=True):
    """An object, with the kinds of its outcomes and their amounts that add up, in order."""

    name: str
    kinds: tuple[tuple[str, tuple[str, ...]], ...]


class GoalShape(msgspec.Struct, frozen=True):
    """A goal, with the amount that counts for it."""

    name: str
    amount: str


class Shape(msgspec.Struct, frozen=True):
    """All that an announcement depends on. ``node`` is the device's id, and ``label`` its name at
    first, which people may change in Home Assistant."""

    node: str
    label: str
    prefix: str
    single_components: bool
    objects: tuple[ObjectShape, ...]
    goals: tuple[GoalShape, ...]
    floor: bool
    regions: tuple[str, ...] = ()
    """Names of parts of the floor."""


def new_node(realm: str, rig: str, instance: str) -> str:
    """Return the id of a device that is announced the first time."""
    text = f"{realm}/{rig}/{instance}"
    return "inhand_" + hashlib.blake2b(text.encode(), digest_size=6).hexdigest()


def object_shape(
    name: str, use: str, seen: Iterable[DayTotal], before: ObjectShape | None
) -> ObjectShape:
    """Return the shape of an object by its use, by what was seen of it, and by what was announced
    of it before: an entity stays as long as its object does."""
    of_use = amounts_by_kind([USES[use]] if use in USES else [])
    kinds = {kind: set(filter(is_shown, amounts)) for kind, amounts in of_use.items()}
    for kind, amounts in before.kinds if before is not None else ():
        kinds.setdefault(kind, set()).update(amounts)
    for total in seen:
        if total.object == name:
            kinds.setdefault(total.kind, set()).update(filter(is_shown, total.amounts))
    return ObjectShape(name, tuple((kind, tuple(sorted(kinds[kind]))) for kind in sorted(kinds)))


def is_shown(amount: str) -> bool:
    """Whether an amount has a total of its own: what adds up, of times the whole duration."""
    return amount == DURATION or (adds_up(amount) and not amount.endswith("_s"))


def goal_shape(goal: Goal) -> GoalShape:
    """Return the shape of a goal."""
    return GoalShape(goal.name, goal.amount)

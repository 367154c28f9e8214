"""Faces that were found stay hidden for a while after they were found last."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from inhand_capture.faces.discs import Disc
from inhand_capture.faces.parameters import DEFAULT_FACES, FaceParameters


@dataclass(frozen=True)
class Head:
    """One head: the discs that hide it, in how many pictures it was found, and when last."""

    discs: tuple[Disc, ...]
    pictures: int
    found_ns: int

    def distance(self, disc: Disc) -> float:
        """Distance of a disc's centre from the nearest of its own, in the larger radius."""
        return min(own.distance(disc) / max(own.radius, disc.radius) for own in self.discs)


class HeldHeads:
    """Follows heads from picture to picture: a place is given up when its head is found elsewhere,
    or after a while."""

    def __init__(self, parameters: FaceParameters = DEFAULT_FACES) -> None:
        self._parameters = parameters
        self._reach = 1.0 + parameters.growth_per_s * parameters.held_s
        self._heads: list[Head] = []

    def see(self, finders: Iterable[Sequence[Disc]], time_ns: int) -> list[Disc]:
        """Return what to hide in a picture, by what each finder found in it.

        Discs of one finder are of different heads, those of several may be of one. So two heads
        that touch are two, and one of them that is lost stays hidden.
        """
        seen: list[Head] = []
        for discs in finders:
            seen = _joined(seen, discs, time_ns)
        # A clock that was set back must not hold a face for ever, nor give it up.
        before = [replace(one, found_ns=min(one.found_ns, time_ns)) for one in self._heads]
        pairs = _nearest_pairs(before, [one.discs for one in seen], self._reach)
        known = {new: before[old].pictures for old, new in pairs}
        found = [replace(one, pictures=1 + known.get(number, 0)) for number, one in enumerate(seen)]
        gone = {old for old, _ in pairs}
        held = [
            one
            for number, one in enumerate(before)
            if number not in gone and time_ns - one.found_ns <= 1e9 * self._parameters.held_s
        ]
        self._heads = found + held
        return [disc for one in self._heads for disc in self._hidden(one, time_ns)]

    def _hidden(self, head: Head, time_ns: int) -> Iterable[Disc]:
        if head.pictures < self._parameters.sure_from:
            return head.discs
        growth = 1.0 + self._parameters.growth_per_s * (time_ns - head.found_ns) / 1e9
        return [disc.grown(growth) for disc in head.discs]


def _joined(heads: Sequence[Head], discs: Sequence[Disc], time_ns: int) -> list[Head]:
    """Add one finder's discs to the heads of a picture, each to another head."""
    joined = list(heads)
    pairs = {new: old for old, new in _nearest_pairs(joined, [(disc,) for disc in discs], 1.0)}
    for number, disc in enumerate(discs):
        if number in pairs:
            head = joined[pairs[number]]
            joined[pairs[number]] = replace(head, discs=(*head.discs, disc))
        else:
            joined.append(Head((disc,), 1, time_ns))
    return joined


def _nearest_pairs(
    heads: Sequence[Head], others: Sequence[tuple[Disc, ...]], reach: float
) -> list[tuple[int, int]]:
    """Return pairs of indices, the nearest first, none beyond a reach, and each index once."""
    distances = sorted(
        (min(head.distance(disc) for disc in discs), old, new)
        for old, head in enumerate(heads)
        for new, discs in enumerate(others)
    )
    pairs: list[tuple[int, int]] = []
    for distance, old, new in distances:
        if distance <= reach and all(old != a and new != b for a, b in pairs):
            pairs.append((old, new))
    return pairs

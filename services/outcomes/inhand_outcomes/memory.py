"""What a watcher has in its head as bytes, so that an end at any moment loses next to nothing.

Sightings are kept in pieces that are written once, and removed when no measure needs them any more;
what was said, what goes on, and where up and the floor are is one small entry.
"""

from collections.abc import Mapping

import msgspec
import numpy as np
import zstandard

from inhand_outcomes.gathering import Holding, Sighting
from inhand_outcomes.outcome import Outcome
from inhand_outcomes.room import Room
from inhand_outcomes.watching import Followed, Watcher

STATE = "state"
PIECES = "sightings/"
MOST_BYTES = 64 << 20
NUMBERS = 7 + 36 + 60


class _Remembered(msgspec.Struct, frozen=True):
    object: str
    person: int | None
    measured_ns: int
    counted_ns: int
    said_until_ns: dict[str, int]
    going_on: list[Outcome]
    used: float = 0.0


class _State(msgspec.Struct, frozen=True):
    followed: list[_Remembered]
    told: dict[str, dict[str, Outcome]]
    up: tuple[float, float, float] | None = None
    floor_height: float | None = None


class _Piece(msgspec.Struct, frozen=True):
    object: str
    person: int | None
    times_ns: list[int]
    sequences: list[int]
    seen: list[bool]
    numbers: bytes


class Memory:
    """Writes what has changed in a watcher since the last time, as entries of a journal."""

    def __init__(self, watcher: Watcher) -> None:
        self._watcher = watcher
        self._written_ns: dict[Holding, int] = {}
        self._pieces: dict[str, tuple[Holding, int]] = {}
        """Pieces by name: whose, and the time of their last sighting."""
        self._state = b""

    def entries(self) -> dict[str, bytes | None]:
        """Return the entries that are new, and None for those that are no longer needed."""
        entries: dict[str, bytes | None] = {}
        for holding, followed in self._watcher.followed.items():
            if piece := self._new_piece(holding, followed):
                name, data = piece
                entries[name] = data
        for name, (holding, last_ns) in list(self._pieces.items()):
            kept = self._watcher.followed.get(holding)
            if kept is None or last_ns < kept.gathering.first_ns:
                entries[name] = None
                del self._pieces[name]
        for holding in self._written_ns.keys() - self._watcher.followed.keys():
            del self._written_ns[holding]
        room = self._watcher.room
        x, y, z = room.up.tolist()
        state = msgspec.msgpack.encode(
            _State(
                [_remembered(holding, one) for holding, one in self._watcher.followed.items()],
                self._watcher.told,
                (x, y, z),
                room.floor_height,
            )
        )
        if state != self._state:
            entries[STATE] = self._state = state
        return entries

    def recall(self, entries: Mapping[str, bytes]) -> None:
        """Fill the watcher with what a journal says; raises ValueError for one that is none."""
        try:
            self._recall(entries)
        except (msgspec.MsgspecError, zstandard.ZstdError) as error:
            raise ValueError(f"no journal of a watcher: {error}") from None

    def _recall(self, entries: Mapping[str, bytes]) -> None:
        if STATE not in entries:
            return
        state = msgspec.msgpack.decode(entries[STATE], type=_State)
        self._watcher.told.update(state.told)
        if state.up is not None:
            self._watcher.room = Room(np.array(state.up), state.floor_height)
        followed: dict[Holding, Followed] = {}
        for one in state.followed:
            holding = Holding(one.object, one.person)
            followed[holding] = self._watcher.follow(holding, one.measured_ns)
            followed[holding].said_until_ns = dict(one.said_until_ns)
            followed[holding].used = one.used
            followed[holding].lasting.counted_ns = one.counted_ns
            followed[holding].lasting.carried = {outcome.kind: outcome for outcome in one.going_on}
        for name in sorted(name for name in entries if name.startswith(PIECES)):
            holding, sightings = _sightings(entries[name])
            if holding in followed and sightings:
                self._pieces[name] = (holding, sightings[-1].time_ns)
                self._written_ns[holding] = sightings[-1].time_ns
                for sighting in sightings:
                    followed[holding].gathering.add(sighting)
        for holding, kept in followed.items():
            if not kept.gathering.sightings:
                del self._watcher.followed[holding]

    def _new_piece(self, holding: Holding, followed: Followed) -> tuple[str, bytes] | None:
        written_ns = self._written_ns.get(holding, 0)
        if written_ns > followed.gathering.last_ns:  # the clock was set back
            written_ns = 0
        new = [one for one in followed.gathering.sightings if one.time_ns > written_ns]
        if not new:
            return None
        self._written_ns[holding] = new[-1].time_ns
        name = f"{PIECES}{holding.object}/{holding.person}/{new[0].time_ns:020}"
        self._pieces[name] = (holding, new[-1].time_ns)
        return name, _piece_bytes(holding, new)


def _remembered(holding: Holding, followed: Followed) -> _Remembered:
    return _Remembered(
        holding.object,
        holding.person,
        followed.measured_ns,
        followed.lasting.counted_ns,
        followed.said_until_ns,
        list(followed.lasting.carried.values()),
        followed.used,
    )


def _piece_bytes(holding: Holding, sightings: list[Sighting]) -> bytes:
    rows = [
        np.concatenate([one.pose, one.covariance.ravel(), one.joints.ravel()]) for one in sightings
    ]
    piece = _Piece(
        holding.object,
        holding.person,
        [one.time_ns for one in sightings],
        [one.sequence for one in sightings],
        [one.seen for one in sightings],
        np.array(rows, "<f4").tobytes(),
    )
    return zstandard.compress(msgspec.msgpack.encode(piece))


def _sightings(data: bytes) -> tuple[Holding, list[Sighting]]:
    plain = zstandard.ZstdDecompressor().decompress(data, max_output_size=MOST_BYTES)
    piece = msgspec.msgpack.decode(plain, type=_Piece)
    rows = np.frombuffer(piece.numbers, "<f4").reshape(-1, NUMBERS).astype(np.float64)
    columns = zip(piece.times_ns, piece.sequences, piece.seen, rows, strict=True)
    return Holding(piece.object, piece.person), [
        Sighting(time_ns, sequence, row[:7], row[7:43].reshape(6, 6), seen, row[43:].reshape(20, 3))
        for time_ns, sequence, seen, row in columns
    ]

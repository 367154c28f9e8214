"""Frames that are looked at, and whether a thing stays where it is in them."""

import numpy as np

from inhand_outcomes.arrays import Array, Flags
from inhand_outcomes.track import Track


def frames_apart(times: Array, step_s: float) -> Flags:
    """Frames (T,) that are a step apart, of rising times (T,)."""
    return np.concatenate([[True], np.diff(np.floor(times / step_s)) > 0])


def runs_of(flags: Flags) -> list[slice]:
    """The stretches of frames (T,) in which a flag is set."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(int), [0]])))
    return [slice(int(first), int(end)) for first, end in edges.reshape(-1, 2)]


def still_frames(track: Track, seconds: float, wander_m: float, least_seen: float) -> Flags:
    """Frames (T,) before which a thing has stayed where it is for so many seconds: it is seen in a
    share of them, ``least_seen``, and nowhere farther than ``wander_m`` from their middle."""
    firsts = np.searchsorted(track.times, track.times - seconds + 1e-6)
    counts = np.arange(len(track)) - firsts + 1
    rows = firsts[:, None] + np.arange(int(counts.max(initial=1)))
    inside = np.arange(rows.shape[1]) < counts[:, None]
    rows = np.minimum(rows, len(track) - 1)
    seen = inside & track.seen[rows]
    numbers = np.maximum(seen.sum(axis=1), 1)
    places = track.positions[rows]
    middles = (places * seen[..., None]).sum(axis=1) / numbers[:, None]
    wander = np.linalg.norm(places - middles[:, None], axis=2)
    still = np.where(seen, wander, 0.0).max(axis=1) < wander_m
    still &= track.seen & (seen.sum(axis=1) >= least_seen * counts)
    return np.asarray(still & (track.times - track.times[0] >= seconds - 1e-6))

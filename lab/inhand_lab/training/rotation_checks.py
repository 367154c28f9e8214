"""Finds recordings whose labels write rotations in another way than is meant.

One alone is unlike all others; where all are, the hand does not stay where it holds the object.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from inhand_runtime.wording import counted
from inhand_schemas.joints import Joint
from inhand_tracker.body.skeleton import RIGHT_HAND, part_bases, pelvis_basis
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Flags
from inhand_tracker.mapping.labelled_sequence import LabelledSequence

from inhand_lab.datasets.dataset import DatasetEntry, DatasetError
from inhand_lab.training.parameters import DEFAULT_TRAINING


def _from_xyzw(turns: Array) -> Array:
    """Read rotations (T, 4) as if (x, y, z, w) were written."""
    return turns[:, [3, 0, 1, 2]]


_READINGS = {
    "its quaternions are (x, y, z, w): write (w, x, y, z)": _from_xyzw,
    "its rotations are inverse, those of the camera in the object's frame: "
    "write camera_from_object": rotations.conjugate,
}
"""How rotations (T, 4) are meant that are written in another way, by the mend."""


def check_rotations(
    entries: Sequence[DatasetEntry], sequences: Sequence[LabelledSequence], mirror_normal: Array
) -> None:
    """Check that an object is turned in the same ways to everybody's body.

    ``mirror_normal`` (3,) is the object's. Raises DatasetError for a recording that is unlike all
    others, and like them if its rotations are read in another way, and for recordings in all of
    which the hand stays much better where it holds the object if they are.
    """
    _check_holds(entries, sequences)
    if len(sequences) < DEFAULT_TRAINING.fewest_compared:
        return
    moments = np.array([_second_moments(one, mirror_normal) for one in sequences])
    for mend, reading in _READINGS.items():
        read_anew = [replace(one, rotations=reading(one.rotations)) for one in sequences]
        anew = np.array([_second_moments(one, mirror_normal) for one in read_anew])
        for index in np.flatnonzero(_fits_better(moments, anew)).tolist():
            entry = entries[index]
            raise DatasetError(
                f"{entry.file}: {entry.object!r} is turned to the body in other ways than in "
                f"{counted(len(entries) - 1, 'other recording')}, and in the same ones if {mend}"
            )


def _check_holds(entries: Sequence[DatasetEntry], sequences: Sequence[LabelledSequence]) -> None:
    """Raise DatasetError where hands in all recordings stay better if read as (x, y, z, w)."""
    spreads = np.array(
        [
            (_hand_spread_m(one), _hand_spread_m(replace(one, rotations=_from_xyzw(one.rotations))))
            for one in sequences
        ]
    )
    spreads = spreads[np.isfinite(spreads).all(axis=1)]
    if not len(spreads) or np.median(spreads[:, 0]) <= DEFAULT_TRAINING.steady_hold_m:
        return
    ratios = spreads[:, 0] / spreads[:, 1]
    if ratios.min() > 1.0 and np.median(ratios) >= DEFAULT_TRAINING.clear_hold_ratio:
        raise DatasetError(
            f"{entries[0].file} and others: hands stay {np.median(ratios):.1f} times as well where "
            f"they hold {entries[0].object!r} if quaternions are (x, y, z, w): write (w, x, y, z)"
        )


def _hand_spread_m(sequence: LabelledSequence) -> float:
    """Return how far a hand usually is from its place in the object's frame while that is moved.

    It is in metres, of the hand that stays better; NaN where the object is seldom moved.
    """
    speeds = np.linalg.norm(np.diff(sequence.translations, axis=0, prepend=np.nan), axis=1)
    moved = speeds * sequence.frame_rate > DEFAULT_TRAINING.moved_m_per_s
    hands = sequence.joints[:, [Joint.HAND_LEFT, Joint.HAND_RIGHT]]
    used = moved & np.isfinite(hands).all(axis=(1, 2)) & np.isfinite(sequence.rotations).all(axis=1)
    if used.sum() < DEFAULT_TRAINING.fewest_moved:
        return np.nan
    apart = hands[used] - sequence.translations[used, None]
    turns = rotations.normalise(sequence.rotations[used])
    held = rotations.rotate(rotations.conjugate(turns)[:, None], apart)
    away = np.linalg.norm(held - np.median(held, axis=0), axis=2)
    return float(np.median(away, axis=0).min())


def _fits_better(moments: Array, anew: Array) -> Flags:
    """Return which of N recordings are like the others if read anew, and clearly unlike as read.

    ``moments`` and ``anew`` are (N, 2, 4, 4).
    """
    count = len(moments)
    pairs = np.einsum("nbij,mbij->nmb", moments, moments)
    own = np.einsum("nnb->nb", pairs)
    before = (pairs.sum(axis=1) - own) / (count - 1)
    others = (moments.sum(axis=0) - moments) / (count - 1)
    after = np.einsum("nbij,nbij->nb", anew, others)
    # How well each recording m agrees with those that are neither m nor n.
    among = (pairs.sum(axis=1) - own - pairs) / (count - 2)
    among[np.arange(count), np.arange(count)] = np.nan
    usual = np.nanmedian(among, axis=1)
    clear = (after - before).max(axis=1) >= DEFAULT_TRAINING.clear_rotation_gain
    like = (after >= DEFAULT_TRAINING.same_rotation_share * usual).all(axis=1)
    return np.asarray(clear & like)


def _second_moments(sequence: LabelledSequence, mirror_normal: Array) -> Array:
    """Return the mean products (2, 4, 4) of rotations' components, in the pelvis' and hand's bases.

    They do not depend on quaternions' signs. The trace of the product of two recordings' is the
    mean squared cosine of half the angle between their rotations.
    """
    sequence = sequence.right_handed(mirror_normal)
    whole = np.isfinite(sequence.joints).all(axis=(1, 2))
    labelled = np.isfinite(sequence.rotations).all(axis=1)
    frames = np.flatnonzero(whole & labelled)
    frames = frames[:: 1 + len(frames) // DEFAULT_TRAINING.compared_frames]
    joints, turns = sequence.joints[frames], sequence.rotations[frames]
    pelvis = pelvis_basis(joints)
    hand = part_bases(joints, pelvis).rotations[:, RIGHT_HAND]
    bases = rotations.conjugate(np.stack((pelvis.rotations, hand)))
    local = rotations.multiply(bases, turns)
    return np.asarray(np.einsum("bti,btj->bij", local, local) / max(len(frames), 1))

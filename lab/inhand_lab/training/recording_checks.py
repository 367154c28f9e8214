"""Checks whether recordings can be learned from; each mistake is one line that says the mend."""

from collections.abc import Sequence

import numpy as np
from inhand_runtime.wording import counted
from inhand_schemas.joints import JOINT_NAMES, Joint
from inhand_tracker.body.skeleton import PELVIS_JOINTS
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Flags
from inhand_tracker.mapping.labelled_sequence import LabelledSequence

from inhand_lab.datasets.dataset import DatasetEntry, DatasetError
from inhand_lab.datasets.facing import foot_directions, is_mirror_image, pointing_forwards
from inhand_lab.datasets.parameters import DEFAULT_DATASET
from inhand_lab.training.absent_joints import absent_of
from inhand_lab.training.parameters import DEFAULT_TRAINING


def check_sequence(entry: DatasetEntry, sequence: LabelledSequence) -> None:
    """Check one recording; raises DatasetError for one that cannot be meant."""
    if len(sequence.joints) == 0:
        raise DatasetError(
            f"{entry.file} holds no skeletons: record it again with a body tracker, or take it "
            "out of dataset.toml"
        )
    _check_labels(entry, sequence)
    _check_jumps(entry, sequence)
    _check_bodies(entry, sequence)
    check_facing(entry, sequence.joints)


def check_facing(entry: DatasetEntry, joints: Array) -> None:
    """Check that feet of a body (T, 20, 3) point forwards of its hips.

    They do however somebody walks, sits or is turned. Raises DatasetError where they point
    backwards in the median frame: left and right, or an axis, are exchanged.
    """
    pointing = pointing_forwards(joints, foot_directions(joints))
    if is_mirror_image(pointing):
        raise DatasetError(
            f"{entry.file}: the whole body is a mirror image, its feet point backwards in "
            f"{_share(int((pointing < 0.0).sum()), len(pointing))}: left and right joints have "
            "each other's names, or an axis has the wrong sign; mend joints and labels alike"
        )


def check_hands(entries: Sequence[DatasetEntry], sequences: Sequence[LabelledSequence]) -> None:
    """Check that an object is at the same hand of everybody, dominant or other.

    Raises DatasetError where it is not: somebody is not as handed as ``dataset.toml`` says.
    """
    shares = np.array([_share_at_dominant_hand(sequence) for sequence in sequences])
    clear = DEFAULT_TRAINING.clear_hand_share
    at_dominant, at_other = shares >= clear, shares <= 1.0 - clear
    if not (at_dominant.any() and at_other.any()):
        return
    odd = at_other if at_other.sum() <= at_dominant.sum() else at_dominant
    index = int(np.flatnonzero(odd)[0])
    entry, hand = entries[index], "other" if odd is at_other else "dominant"
    mended = "right" if entry.handedness == "left" else "left"
    others = int((~odd & (at_dominant | at_other)).sum())
    raise DatasetError(
        f"{entry.file}: {entry.object!r} is at the {hand} hand of a {entry.handedness}-handed "
        f"person, unlike in {counted(others, 'other recording')}: "
        f'write handedness = "{mended}" in dataset.toml, or take the recording out'
    )


def _check_labels(entry: DatasetEntry, sequence: LabelledSequence) -> None:
    labelled = np.asarray(np.isfinite(sequence.translations).all(axis=1))
    # Frames without body and label say nothing: somebody else has the object, or nobody is there.
    frames = int((labelled | _shown(sequence)).sum())
    unlabelled = frames - int(labelled.sum())
    if unlabelled > DEFAULT_TRAINING.most_missing_share * frames:
        raise DatasetError(
            f"{entry.file} has no label of {entry.object!r} in {_share(unlabelled, frames)}, and "
            f"{DEFAULT_TRAINING.most_missing_share:.0%} may lack one: label it, or take it out of "
            "dataset.toml"
        )


def _shown(sequence: LabelledSequence) -> Flags:
    """Flag (T,) the frames that show a joint."""
    return np.asarray(np.asarray(np.isfinite(sequence.joints).all(axis=2)).any(axis=1))


def _check_jumps(entry: DatasetEntry, sequence: LabelledSequence) -> None:
    moved = np.linalg.norm(np.diff(sequence.translations, axis=0), axis=1)
    turned = rotations.angle_between(sequence.rotations[:-1], sequence.rotations[1:])
    for frame in np.flatnonzero(moved * sequence.frame_rate > DEFAULT_DATASET.fastest_m_per_s):
        raise DatasetError(
            f"{entry.file}: the label jumps by {moved[frame]:.2f} m after frame {frame}: "
            "mend that label"
        )
    for frame in np.flatnonzero(turned * sequence.frame_rate > DEFAULT_DATASET.fastest_rad_per_s):
        raise DatasetError(
            f"{entry.file}: the label turns by {np.degrees(turned[frame]):.0f}° after frame "
            f"{frame}: mend that label"
        )


def _check_bodies(entry: DatasetEntry, sequence: LabelledSequence) -> None:
    seen = np.asarray(np.isfinite(sequence.joints).all(axis=2))
    labelled = np.asarray(np.isfinite(sequence.translations).all(axis=1))
    seen = seen[labelled | seen.any(axis=1)]
    frames = len(seen)
    most_missing = DEFAULT_TRAINING.most_missing_share * frames
    nobody = int((~seen.any(axis=1)).sum())
    if nobody > most_missing:
        raise DatasetError(
            f"{entry.file} does not show the person in {_share(nobody, frames)}: record it again, "
            "or take it out of dataset.toml"
        )
    # Joints that are never seen have stand-ins.
    seen[:, list(absent_of(sequence.joints))] = True
    without_pelvis = int((~seen[:, PELVIS_JOINTS].all(axis=1)).sum())
    if without_pelvis > most_missing:
        needed = ", ".join(JOINT_NAMES[joint] for joint in sorted(PELVIS_JOINTS))
        raise DatasetError(
            f"{entry.file} has no pelvis in {_share(without_pelvis, frames)}, and body poses are "
            f"measured from it: record so that {needed} are tracked"
        )
    incomplete = int((~seen.all(axis=1)).sum())
    if incomplete > most_missing:
        worst = JOINT_NAMES[int(np.argmin(seen.sum(axis=0)))]
        raise DatasetError(
            f"{entry.file} lacks joints in {_share(incomplete, frames)}, {worst} most often, and "
            f"{DEFAULT_TRAINING.most_missing_share:.0%} may: record so that the whole body is "
            "seen, or legs, hips, spine or hands never, in any recording"
        )


def _share_at_dominant_hand(sequence: LabelledSequence) -> float:
    """Share of frames in which the object is nearer to the dominant hand than to the other, of
    those in which it is much nearer to one; a half where these are few, as of a box in both."""
    hands = sequence.joints[:, [Joint.HAND_RIGHT, Joint.HAND_LEFT]]
    right, left = np.linalg.norm(hands - sequence.translations[:, None], axis=2).T
    seen = np.isfinite(right) & np.isfinite(left)
    with np.errstate(invalid="ignore"):
        apart = np.minimum(right, left) < DEFAULT_TRAINING.clear_hand_ratio * np.maximum(
            right, left
        )
    if not seen.any() or apart[seen].mean() < DEFAULT_TRAINING.fewest_clear_share:
        return 0.5
    nearer = left < right if sequence.left_handed else right < left
    return float(nearer[seen & apart].mean())


def _share(count: int, frames: int) -> str:
    return f"{count} of {frames} frames"

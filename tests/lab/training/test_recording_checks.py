"""Which recordings are refused, and which are not."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
import pytest
from inhand_lab.datasets.dataset import DatasetEntry, DatasetError
from inhand_lab.datasets.units import check_units
from inhand_lab.importers.messages import imported_skeletons
from inhand_lab.importers.motion_archive import read_motion
from inhand_lab.importers.utd_mhad import read_trial
from inhand_lab.training.recording_checks import check_facing, check_hands, check_sequence
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.simulation import simulate
from inhand_schemas.joints import JOINT_NAMES, MIRRORED_JOINTS, Joint
from inhand_tracker.body.skeleton import mirror_joints
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from real_data import DATA, needs_real_data
from scipy.spatial.transform import Rotation
from waving import waving

ENTRY = DatasetEntry(file="recordings/a.mcap", interaction="drink", participant="p0", object="mug")
WALKING = waving(20, 0)[0]
TURNED = np.array([0.0, 1.0, 0.0, 0.0])


def recording(frames: int = 20, *, left_handed: bool = False) -> LabelledSequence:
    """Somebody who stands with an object in the right hand."""
    joints = np.random.default_rng(0).normal(size=(20, 3)).repeat(frames, 0).reshape(20, frames, 3)
    joints = joints.swapaxes(0, 1).copy()
    places = joints[:, Joint.HAND_RIGHT] + [0.0, 0.0, 0.05]
    turns = np.tile([1.0, 0.0, 0.0, 0.0], (frames, 1))
    return LabelledSequence("p0", left_handed, joints, places, turns)


def without_labels(sequence: LabelledSequence, frames: int) -> LabelledSequence:
    translations = sequence.translations.copy()
    translations[:frames] = np.nan
    return replace(sequence, translations=translations)


def without_joint(sequence: LabelledSequence, name: str, frames: int) -> LabelledSequence:
    joints = sequence.joints.copy()
    joints[:frames, JOINT_NAMES.index(name)] = np.nan
    return replace(sequence, joints=joints)


def moved_at(sequence: LabelledSequence, frame: int, metres: float) -> LabelledSequence:
    translations = sequence.translations.copy()
    translations[frame, 0] += metres
    return replace(sequence, translations=translations)


def turned_at(sequence: LabelledSequence, frame: int) -> LabelledSequence:
    rotations = sequence.rotations.copy()
    rotations[frame] = TURNED
    return replace(sequence, rotations=rotations)


REFUSED: dict[str, tuple[Callable[[LabelledSequence], LabelledSequence], str]] = {
    "labels": (lambda s: without_labels(s, 11), "no label of 'mug' in 11 of 20 frames, and 50%"),
    "a place": (lambda s: moved_at(s, 7, 2.5), "jumps by 2.50 m after frame 6: mend that label"),
    "a turn": (lambda s: turned_at(s, 7), "turns by 180° after frame 6: mend that label"),
    "the pelvis": (
        lambda s: without_joint(s, "HipLeft", 11),
        "no pelvis in 11 of 20 frames, .*HipCenter, Spine, HipLeft, HipRight",
    ),
    "a person": (
        lambda s: replace(s, joints=np.full_like(s.joints, np.nan)),
        "does not show the person in 20 of 20 frames: record it again, or take it out",
    ),
    "a joint": (
        lambda s: without_joint(s, "FootLeft", 11),
        "lacks joints in 11 of 20 frames, FootLeft most often, and 50% may",
    ),
    "everything": (
        lambda s: LabelledSequence("p0", False, s.joints[:0], s.translations[:0], s.rotations[:0]),
        "holds no skeletons",
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_a_recording_that_cannot_be_meant_is_refused_in_one_line(what: str) -> None:
    spoil, message = REFUSED[what]
    with pytest.raises(DatasetError, match=message) as caught:
        check_sequence(ENTRY, spoil(recording()))
    assert str(caught.value).startswith("recordings/a.mcap")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "spoil",
    [
        lambda s: s,
        lambda s: without_labels(s, 10),
        lambda s: without_joint(s, "HipLeft", 10),
        lambda s: without_joint(s, "FootLeft", 10),
        lambda s: moved_at(s, 7, 1.9),
    ],
)
def test_what_may_be_missing_or_fast_is_accepted(
    spoil: Callable[[LabelledSequence], LabelledSequence],
) -> None:
    check_sequence(ENTRY, spoil(recording()))


def test_a_label_may_go_far_while_it_is_not_given() -> None:
    far = moved_at(recording(), 9, 5.0)
    far.translations[8] = far.translations[10] = np.nan
    check_sequence(ENTRY, far)


def test_a_person_with_the_wrong_handedness_is_named() -> None:
    entries = [replaced(ENTRY, file=f"{name}.mcap") for name in "abc"]
    entries[1] = replaced(entries[1], handedness="left")
    sequences = [recording(), recording(left_handed=True), recording()]
    with pytest.raises(DatasetError, match=r"b\.mcap.*other hand of a left-handed") as caught:
        check_hands(entries, sequences)
    assert 'handedness = "right"' in str(caught.value)


def test_the_only_one_who_uses_the_dominant_hand_is_named() -> None:
    entries = [replaced(ENTRY, file=f"{name}.mcap", handedness="left") for name in "abc"]
    entries[2] = replaced(entries[2], handedness="right")
    sequences = [recording(left_handed=True), recording(left_handed=True), recording()]
    with pytest.raises(DatasetError, match=r"c\.mcap.*dominant hand of a right-handed"):
        check_hands(entries, sequences)


def test_an_object_in_both_hands_tells_nothing_of_handedness() -> None:
    between = recording()
    hands = between.joints[:, [Joint.HAND_RIGHT, Joint.HAND_LEFT]]
    places = hands.mean(axis=1)
    places[::2] = hands[::2, 0]
    places[1::2] = hands[1::2, 1]
    both = replace(between, translations=places)
    check_hands([ENTRY] * 3, [both, replace(both, left_handed=True), recording()])


def test_a_box_in_both_hands_that_is_always_a_little_nearer_to_one_tells_nothing_either() -> None:
    def carried(share: float) -> LabelledSequence:
        one = recording()
        right, left = (one.joints[:, joint] for joint in (Joint.HAND_RIGHT, Joint.HAND_LEFT))
        return replace(one, translations=share * right + (1.0 - share) * left)

    check_hands([ENTRY] * 3, [carried(0.45), carried(0.55), carried(0.55)])


def test_a_body_whose_feet_point_backwards_is_a_mirror_image() -> None:
    for mirrored in (WALKING[:, list(MIRRORED_JOINTS)], WALKING * [-1.0, 1.0, 1.0]):
        with pytest.raises(
            DatasetError, match=r"a\.mcap: the whole body is a mirror image, its feet"
        ):
            check_facing(ENTRY, mirrored)


def test_a_body_may_face_anywhere_lie_turn_and_hide_its_feet() -> None:
    for axes, angles in (("y", 180), ("y", 90), ("x", 90), ("xyz", (100, 170, 20))):
        turn = Rotation.from_euler(axes, angles, degrees=True)
        check_facing(ENTRY, turn.apply(WALKING.reshape(-1, 3)).reshape(WALKING.shape))
    check_facing(ENTRY, mirror_joints(WALKING))
    hidden = WALKING[:, list(MIRRORED_JOINTS)]
    hidden[:, [Joint.FOOT_LEFT, Joint.FOOT_RIGHT]] = np.nan
    check_facing(ENTRY, hidden)


@pytest.mark.long
def test_no_simulated_person_is_a_mirror_image_and_all_mirror_images_are_found() -> None:
    for interaction in INTERACTIONS:
        for participant in range(2):
            joints = simulate(interaction, participant, seed=11, frames=60).joints_in_camera
            check_facing(ENTRY, joints)
            with pytest.raises(DatasetError, match="mirror image"):
                check_facing(ENTRY, joints[:, list(MIRRORED_JOINTS)])


@needs_real_data
@pytest.mark.long
def test_no_real_person_is_in_another_unit_or_a_mirror_image() -> None:
    trials = [read_trial(path) for path in sorted((DATA / "utd-mhad").glob("*_skeleton.mat"))]
    golf = [read_motion(path) for path in sorted((DATA / "motion").glob("golf*.npz"))]
    box = read_motion(DATA / "motion" / "repaired" / "sub3_largebox_003.npz")
    shown = [trial.joints_in_camera for trial in trials]
    shown += [motion.joints for motion in (*golf, box)]
    assert len(shown) > 100
    for joints in shown:
        check_facing(ENTRY, joints)
        frames = [imported_skeletons(number, number, one) for number, one in enumerate(joints)]
        check_units(Path("real.mcap"), frames, [None] * len(frames))


def replaced(entry: DatasetEntry, **changes: str) -> DatasetEntry:
    return msgspec.structs.replace(entry, **changes)

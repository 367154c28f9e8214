"""Learning against the spec's formulas, written out again in loops (section 2 of P14)."""

from collections import Counter
from dataclasses import dataclass, replace

import numpy as np
import pytest
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.mapping.learning import STAGES, UnusableSequenceError, learn
from inhand_tracker.mapping.mapping import Mapping
from inhand_tracker.mapping.parameters import DEFAULT_MAPPING
from people import KINECT_TREE as TREE
from people import STANDING, held, move, quaternion_of, same_rotation, sequence, waving
from scipy.spatial.transform import Rotation

NORMAL = np.array([0.6, 0.0, 0.8])
OTHER_SIDE = [0, 1, 2, 3, 8, 9, 10, 11, 4, 5, 6, 7, 16, 17, 18, 19, 12, 13, 14, 15]


@dataclass
class Literal:
    """One sequence after the spec, frame by frame; ``frames`` are the original numbers."""

    participant: str
    frames: list[int]
    body_poses: np.ndarray
    translations: np.ndarray
    rotations: np.ndarray


def reflection(normal: np.ndarray) -> np.ndarray:
    return np.eye(3) - 2.0 * np.outer(normal, normal)


def literal(given: LabelledSequence) -> Literal:
    joints = given.joints.copy()
    places = given.translations.copy()
    turns = [
        np.full((3, 3), np.nan)
        if np.isnan(q).any()
        else Rotation.from_quat(q, scalar_first=True).as_matrix()
        for q in given.rotations
    ]
    if given.left_handed:
        across = reflection(np.array([1.0, 0.0, 0.0]))
        joints = joints[:, OTHER_SIDE] @ across
        places = places @ across
        turns = [across @ turn @ reflection(NORMAL) for turn in turns]
    lengths = np.linalg.norm([joints[:, c] - joints[:, p] for p, c in TREE], axis=-1)
    typical = [np.median(of_part[~np.isnan(of_part)]) for of_part in lengths]
    trunk = typical[0] + typical[1] + typical[2]
    legs = (typical[12] + typical[13] + typical[16] + typical[17]) / 2
    height = (trunk + legs) / 0.896

    frames, poses, translations, rotations = [], [], [], []
    for frame in range(len(joints)):
        j = joints[frame]
        if np.isnan(j).any() or np.isnan(places[frame]).any() or np.isnan(turns[frame]).any():
            continue
        x = j[12] - j[16]
        z = np.cross(x, j[1] - j[0])
        y = np.cross(z, x)
        pelvis = np.column_stack([axis / np.linalg.norm(axis) for axis in (x, y, z)])
        frames.append(frame)
        poses.append(np.concatenate([pelvis.T @ (joint - j[0]) / height for joint in j]))
        by_part, turned = [], []
        for parent, child in TREE:
            along = (j[child] - j[parent]) / np.linalg.norm(j[child] - j[parent])
            axis = np.cross(pelvis[:, 2], along)
            axis *= np.arccos(np.clip(pelvis[:, 2] @ along, -1, 1)) / np.linalg.norm(axis)
            basis = Rotation.from_rotvec(axis).as_matrix() @ pelvis
            by_part.append(basis.T @ (places[frame] - j[parent]) / height)
            turned.append(quaternion_of(Rotation.from_matrix(basis.T @ turns[frame])))
        translations.append(by_part)
        rotations.append(turned)
    return Literal(
        given.participant, frames, np.array(poses), np.array(translations), np.array(rotations)
    )


def theta(first: np.ndarray, second: np.ndarray) -> float:
    return float(np.arccos(min(abs(float(first @ second)), 1.0)))


def delta(index: int, all_sequences: list[Literal]) -> float:
    own = all_sequences[index]
    others = [s for s in all_sequences if s.participant != own.participant]
    if not others:
        others = [s for number, s in enumerate(all_sequences) if number != index]
    nearest = [
        min(float(np.linalg.norm(b - other)) for s in others for other in s.body_poses)
        for b in own.body_poses
    ]
    return float(np.median(nearest))


def check(mapping: Mapping, index: int, all_sequences: list[Literal]) -> None:
    own = all_sequences[index]
    count = len(own.frames)
    rows = slice(mapping.starts[index], mapping.starts[index + 1])
    np.testing.assert_allclose(mapping.body_poses[rows], own.body_poses, atol=1e-9)
    np.testing.assert_allclose(mapping.translations[rows], own.translations, atol=1e-9)
    assert same_rotation(mapping.rotations[rows], own.rotations)
    radius = delta(index, all_sequences)
    assert mapping.radii[index] == pytest.approx(radius)

    for n in range(count):
        row = mapping.starts[index] + n
        cluster = [
            c
            for c in range(count)
            if c == n or np.linalg.norm(own.body_poses[c] - own.body_poses[n]) <= radius
        ]
        phi_e, phi_t, psi_e, psi_t, psi_p = [], [], [], [], []
        for part in range(19):
            a, q = own.translations[:, part], own.rotations[:, part]
            mean_a = sum(a[c] for c in cluster) / len(cluster)
            # Markley's mean as the first right singular vector of the stacked quaternions.
            mean_q = np.linalg.svd(np.array([q[c] for c in cluster]))[2][0]
            phi_e.append(np.mean([np.sum((a[c] - mean_a) ** 2) for c in cluster]))
            phi_t.append(np.mean([theta(q[c], mean_q) ** 2 for c in cluster]))
            pairs = [
                (c, c + 1)
                for c in cluster
                if c + 1 < count and own.frames[c + 1] == own.frames[c] + 1
            ]
            psi_e.append([np.linalg.norm(a[c] - a[d]) for c, d in pairs])
            psi_t.append([theta(q[c], q[d]) for c, d in pairs])
            psi_p.append(np.mean([np.linalg.norm(a[c]) for c in cluster]))
        assert mapping.translation_variation[row] == pytest.approx(np.median(phi_e), abs=1e-12)
        assert mapping.rotation_variation[row] == pytest.approx(np.median(phi_t), abs=1e-9)
        assert mapping.proximate_part[row] == np.argmin(psi_p)
        if psi_e[0]:
            assert mapping.stable_translation_part[row] == np.argmin(np.mean(psi_e, axis=1))
            assert mapping.stable_rotation_part[row] == np.argmin(np.mean(psi_t, axis=1))


def with_gaps(given: LabelledSequence) -> LabelledSequence:
    """Frames 3, 4 and 11 lack a joint, 7 the object's place and 15 its rotation."""
    joints, places, turns = (a.copy() for a in (given.joints, given.translations, given.rotations))
    joints[3:5, 6] = np.nan
    joints[11, 0] = np.nan
    places[7, 1] = np.nan
    turns[15] = np.nan
    return LabelledSequence(given.participant, given.left_handed, joints, places, turns)


CASES = {
    "three participants": lambda: [sequence(f"p{i}", 24 + i, seed=i) for i in range(3)],
    "two recordings of one of the participants": lambda: [
        sequence(who, 20, seed=i) for i, who in enumerate(("p0", "p0", "p1"))
    ],
    "a single participant": lambda: [sequence("p0", 18 + i, seed=i) for i in range(3)],
    "frames that are not usable": lambda: [
        with_gaps(sequence("p0", 24, seed=0)),
        sequence("p1", 20, seed=1),
        with_gaps(sequence("p2", 22, seed=2)),
    ],
    "a left-handed participant": lambda: [
        sequence("p0", 16, seed=0),
        sequence("p1", 16, seed=1, left_handed=True),
    ],
}


@pytest.mark.parametrize("name", CASES)
def test_what_is_learned_is_what_the_formulas_say(name: str) -> None:
    sequences = CASES[name]()
    mapping = learn(sequences, NORMAL)
    expected = [literal(one) for one in sequences]
    assert mapping.participants == tuple(one.participant for one in sequences)
    assert np.diff(mapping.starts).tolist() == [len(one.frames) for one in expected]
    for index in range(len(sequences)):
        check(mapping, index, expected)


def test_unusable_frames_are_left_out() -> None:
    mapping = learn(CASES["frames that are not usable"](), NORMAL)
    assert np.diff(mapping.starts).tolist() == [19, 20, 17]
    for array in (mapping.body_poses, mapping.translations, mapping.rotations):
        assert np.isfinite(array).all()


def test_clusters_differ_in_size_in_these_cases() -> None:
    """The formulas are not tested on clusters of one frame only."""
    mapping = learn(CASES["three participants"](), NORMAL)
    assert np.mean(mapping.translation_variation > 1e-9) > 0.3


def test_the_mapping_does_not_change_when_a_scene_moves() -> None:
    plain = [sequence(f"p{i}", 16, seed=i) for i in range(2)]
    turn, shift = Rotation.from_rotvec([1.0, -0.4, 2.0]), np.array([3.0, -1.0, 0.5])
    moved = LabelledSequence(
        "p0",
        False,
        move(turn, shift, plain[0].joints),
        move(turn, shift, plain[0].translations),
        quaternion_of(turn * Rotation.from_quat(plain[0].rotations, scalar_first=True)),
    )
    first, second = learn(plain, NORMAL), learn([moved, plain[1]], NORMAL)
    np.testing.assert_allclose(first.translations, second.translations, atol=1e-9)
    np.testing.assert_allclose(first.radii, second.radii)
    np.testing.assert_allclose(first.rotation_variation, second.rotation_variation, atol=1e-9)


def test_a_person_of_another_size_gives_the_same_mapping() -> None:
    plain = [sequence(f"p{i}", 16, seed=i) for i in range(2)]
    child = LabelledSequence(
        "p0", False, 0.6 * plain[0].joints, 0.6 * plain[0].translations, plain[0].rotations
    )
    first, second = learn(plain, NORMAL), learn([child, plain[1]], NORMAL)
    np.testing.assert_allclose(first.translations, second.translations, atol=1e-9)
    np.testing.assert_allclose(first.body_poses, second.body_poses, atol=1e-9)


def test_a_mirrored_left_handed_recording_teaches_the_same() -> None:
    """The mirror image of a right-handed person, called left-handed."""
    plain = [sequence(f"p{i}", 16, seed=i) for i in range(2)]
    across = reflection(np.array([1.0, 0.0, 0.0]))
    turns = Rotation.from_quat(plain[0].rotations, scalar_first=True).as_matrix()
    mirrored = LabelledSequence(
        "p0",
        True,
        plain[0].joints[:, OTHER_SIDE] @ across,
        plain[0].translations @ across,
        quaternion_of(Rotation.from_matrix(across @ turns @ reflection(NORMAL))),
    )
    first, second = learn(plain, NORMAL), learn([mirrored, plain[1]], NORMAL)
    np.testing.assert_allclose(first.translations, second.translations, atol=1e-9)
    assert same_rotation(first.rotations, second.rotations)
    np.testing.assert_array_equal(first.proximate_part, second.proximate_part)


def test_an_object_fixed_to_a_part_is_stablest_there() -> None:
    """Glasses on the head, a person who moves all but the pelvis."""
    random = np.random.default_rng(5)
    recordings = []
    for who in range(2):
        joints = np.repeat(STANDING[None], 30, axis=0)
        sway = np.cumsum(0.01 * random.normal(size=(30, 20, 3)), axis=0)
        joints = joints + sway
        joints[:, 2] = STANDING[2] + 0.02 * random.normal(size=(30, 3))
        joints[:, 3] = joints[:, 2] + [0.0, -0.278, 0.0]
        places = joints[:, 3] + [0.0, 0.0, -0.05]
        turns = np.tile([1.0, 0.0, 0.0, 0.0], (30, 1))
        joints[:, [0, 1, 12, 16]] = STANDING[[0, 1, 12, 16]]
        recordings.append(LabelledSequence(f"p{who}", False, joints, places, turns))
    mapping = learn(recordings, NORMAL)
    head, spine = 2, 0
    assert set(mapping.stable_translation_part.tolist()) == {head}
    # The rotation is as still for every part whose direction never changes: the spine, the head,
    # the hips; the first of them wins up to rounding.
    assert set(mapping.stable_rotation_part.tolist()) <= {spine, head, 11, 15}


def test_a_part_that_holds_the_object_s_place_is_the_nearest() -> None:
    joints = waving(12)
    recordings = [
        LabelledSequence(who, False, joints + shift, joints[:, 10] + shift, held(joints)[1])
        for who, shift in (("p0", 0.0), ("p1", 0.1))
    ]
    mapping = learn(recordings, NORMAL)
    # The hand's part begins at the wrist, joint 10.
    assert set(mapping.proximate_part.tolist()) == {10}
    np.testing.assert_allclose(mapping.translations[:, 10], 0.0, atol=1e-9)


def test_like_body_poses_with_unlike_objects_vary() -> None:
    joints = np.repeat(STANDING[None], 4, axis=0)
    places = np.array([[0, 0, 2.0], [0.3, 0, 2.0], [0, 0, 2.0], [0.3, 0, 2.0]])
    turns = quaternion_of(Rotation.from_rotvec(np.deg2rad([[0, 0, a] for a in (0, 60, 0, 60)])))
    recording = LabelledSequence("p0", False, joints, places, turns)
    other = LabelledSequence("p1", False, joints, places, turns)
    mapping = learn([recording, other], NORMAL)
    height = (0.728 + 0.88) / 0.896
    np.testing.assert_array_equal(mapping.radii, [0.0, 0.0])
    # Both lie 15 cm and θ = 15° (half of 30°) from their mean.
    np.testing.assert_allclose(mapping.translation_variation, (0.15 / height) ** 2)
    np.testing.assert_allclose(mapping.rotation_variation, np.deg2rad(15.0) ** 2)


@pytest.mark.parametrize("frames", [2, 3])
def test_the_shortest_sequences_can_be_learned_from(frames: int) -> None:
    mapping = learn([sequence(f"p{i}", frames, seed=i) for i in range(2)], NORMAL)
    assert mapping.starts.tolist() == [0, frames, 2 * frames]
    for part in (mapping.stable_translation_part, mapping.stable_rotation_part):
        assert part.min() >= 0
        assert part.max() <= 18


def test_two_frames_with_a_gap_between_can_be_learned_from() -> None:
    holed = sequence("p0", 5)
    holed.joints[1:4] = np.nan
    mapping = learn([holed, sequence("p1", 5, seed=1)], NORMAL)
    assert mapping.starts.tolist() == [0, 2, 7]


def test_one_sequence_is_too_few() -> None:
    with pytest.raises(UnusableSequenceError, match="two are the least"):
        learn([sequence("p0", 5)], NORMAL)
    with pytest.raises(UnusableSequenceError, match="two are the least"):
        learn([], NORMAL)


@pytest.mark.parametrize("usable", [0, 1])
def test_a_sequence_without_two_usable_frames_is_refused_by_name(usable: int) -> None:
    holed = sequence("anna", 6)
    holed.joints[usable:, 7] = np.nan
    with pytest.raises(UnusableSequenceError, match=f"'anna' has {usable} frame"):
        learn([holed, sequence("p1", 5)], NORMAL)


def test_labels_need_not_be_unit_quaternions_to_the_last_digit() -> None:
    """A message's rotation may be 0.1 % off: as a separation that would be 2.6°."""
    exact = [sequence(f"p{i}", 12, seed=i) for i in range(2)]
    rough = [replace(one, rotations=0.9991 * one.rotations) for one in exact]
    first, second = learn(exact, NORMAL), learn(rough, NORMAL)
    np.testing.assert_allclose(second.rotation_variation, first.rotation_variation, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(second.rotations, axis=-1), 1.0)


def test_labels_without_a_rotation_are_left_out() -> None:
    odd = sequence("p0", 8)
    odd.rotations[5] = 0.0
    mapping = learn([odd, sequence("p1", 8, seed=1)], NORMAL)
    assert mapping.starts.tolist() == [0, 7, 15]


def test_frames_without_a_pelvis_are_left_out() -> None:
    odd = sequence("p0", 8)
    odd.joints[2] = 0.0
    odd.joints[3, 12] = odd.joints[3, 16]
    mapping = learn([odd, sequence("p1", 8, seed=1)], NORMAL)
    assert mapping.starts.tolist() == [0, 6, 14]
    assert np.isfinite(mapping.rotations).all()


def test_every_stage_is_reported_once_a_sequence() -> None:
    reported: Counter[str] = Counter()
    learn(CASES["three participants"](), NORMAL, lambda stage: reported.update([stage]))
    assert reported == dict.fromkeys(STAGES, 3)


def learned(recordings: list[LabelledSequence], **parameters: int) -> Mapping:
    return learn(recordings, NORMAL, parameters=replace(DEFAULT_MAPPING, **parameters))


def test_clusters_of_a_long_sequence_are_those_of_its_stretches() -> None:
    """Cut into stretches, frames measure as if each stretch had been learned by itself."""
    whole = [sequence(f"p{i}", 48, seed=i) for i in range(2)]
    uncut = learn(whole, NORMAL)
    cut = learned(whole, longest_stretch=24)
    np.testing.assert_array_equal(cut.starts, uncut.starts)
    np.testing.assert_array_equal(cut.radii, uncut.radii)
    assert not np.allclose(cut.translation_variation, uncut.translation_variation)
    poses = cut.body_poses
    for frame in range(96):
        first = frame - frame % 24
        near = np.linalg.norm(poses[first : first + 24] - poses[frame], axis=1)
        cluster = first + np.flatnonzero(near <= cut.radii[frame // 48])
        places = cut.translations[cluster]
        spread = np.square(places - places.mean(axis=0)).sum(axis=-1).mean(axis=0)
        assert cut.translation_variation[frame] == pytest.approx(np.median(spread), abs=1e-12)


@pytest.mark.parametrize("participants", [2, 5, 11])
def test_radii_of_many_frames_are_hardly_larger(participants: int) -> None:
    people = [sequence(f"p{i}", 60, seed=i) for i in range(participants)]
    exact = learn(people, NORMAL).radii
    grouped = learned(people, exact_frames=0).radii
    assert (grouped >= exact * (1.0 - 1e-5)).all()
    if participants <= DEFAULT_MAPPING.groups:
        np.testing.assert_allclose(grouped, exact, rtol=1e-5)
    assert np.median(grouped) <= 1.05 * np.median(exact)


def test_many_frames_of_one_participant_are_compared_between_recordings() -> None:
    recordings = CASES["a single participant"]()
    exact = learn(recordings, NORMAL).radii
    np.testing.assert_allclose(learned(recordings, exact_frames=0).radii, exact, rtol=1e-5)

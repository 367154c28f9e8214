"""Real movement with a simulated object: what is measured, what is true, and what is held."""

from pathlib import Path

import numpy as np
import pytest
from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.datasets.labelled_sequence import labelled_sequence
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.driven.dataset import DrivenSettings, generate_driven, pairs_for, recorded_body
from inhand_lab.driven.denoising import bone_lengths, denoise
from inhand_lab.driven.recorded_body import RecordedBody, drive
from inhand_lab.geometry.transforms import MIRROR
from inhand_lab.importers.utd_mhad import import_utd_mhad
from inhand_lab.motions.performance import ContactKind
from inhand_lab.world.messages import person_message
from inhand_lab.world.simulation import Simulation, simulate
from inhand_schemas.joints import MIRRORED_JOINTS, PARENTS, Joint
from inhand_schemas.messages import Message, Skeletons
from inhand_tracker.geometry.arrays import Array
from performers import angles_at
from real_data import DATA
from scipy.spatial.transform import Rotation

REAL = DATA / "utd-mhad"
SECONDS = 4
SWINGS = [REAL / f"a{action}_s{person}_t1_skeleton.mat" for action in (15, 16) for person in (1, 6)]

needs_real_data = pytest.mark.skipif(not REAL.is_dir(), reason=f"no real data: {REAL}")


def source(interaction: str = "sweepFloor", participant: int = 1) -> Simulation:
    """Somebody to be recorded, whose true body is known; not the beginning, where they wait."""
    return simulate(interaction, participant, seed=3)


def recorded(simulation: Simulation, **changes: object) -> RecordedBody:
    """The measured skeleton of some seconds of it."""
    shown = slice(90, 90 + 30 * SECONDS)
    fields = {
        "joints": simulation.joints_in_camera[shown],
        "states": simulation.joint_states[shown],
        "confidences": simulation.joint_confidences[shown],
        "frame_rate": 30.0,
        "handedness": simulation.person.handedness,
        "participant": 0,
        "recording": 0,
    }
    return RecordedBody(**(fields | changes))  # type: ignore[arg-type]


def turns(simulation: Simulation) -> Array:
    """The object's turn (T-1,) from each frame to the next, degrees."""
    rotations = Rotation.from_matrix(simulation.camera_from_object.rotation)
    return np.asarray(np.degrees((rotations[:-1].inv() * rotations[1:]).magnitude()))


def test_denoised_bones_have_one_length_on_both_sides() -> None:
    joints = denoise(recorded(source()).joints, 30.0)
    lengths = np.linalg.norm(joints[:, 1:] - joints[:, PARENTS[1:]], axis=2)
    assert np.ptp(lengths, axis=0).max() < 1e-9
    assert np.allclose(lengths[0], lengths[0, np.array(MIRRORED_JOINTS[1:]) - 1])


def test_denoised_elbows_keep_within_their_limit() -> None:
    body = recorded(source())
    folded = body.joints.copy()
    folded[:, Joint.WRIST_RIGHT] = folded[:, Joint.SHOULDER_RIGHT] + [0.0, 0.0, 0.02]
    joints = denoise(folded, 30.0)
    arm = Joint.SHOULDER_RIGHT, Joint.ELBOW_RIGHT, Joint.WRIST_RIGHT
    assert angles_at(joints, *arm).min() > 29.9


def test_denoising_brings_fast_noise_nearer_to_the_truth() -> None:
    truth = source().true_joints_in_camera
    noisy = truth + np.random.default_rng(0).normal(0.0, 0.02, truth.shape)
    before, after = (np.linalg.norm(each - truth, axis=2) for each in (noisy, denoise(noisy, 30.0)))
    assert np.median(after) < 0.6 * np.median(before)


def test_a_wrist_that_leaves_its_arm_for_a_moment_is_brought_back() -> None:
    truth = source().true_joints_in_camera[:120]
    measured = truth.copy()
    measured[50:54, Joint.WRIST_RIGHT] += [0.3, 0.2, 0.0]
    error = np.linalg.norm(denoise(measured, 30.0) - truth, axis=2)[:, Joint.WRIST_RIGHT]
    assert error[45:60].max() < 0.08


def test_a_gap_is_bridged() -> None:
    truth = source().true_joints_in_camera[:120]
    measured = truth.copy()
    measured[60:66] = np.nan
    measured[30:40, Joint.FOOT_LEFT] = np.nan
    assert np.linalg.norm(denoise(measured, 30.0) - truth, axis=2).max() < 0.08


def test_the_tracker_is_given_what_was_measured() -> None:
    body = recorded(source())
    driven = drive(body, "drinkFromMug", seed=1)
    assert np.array_equal(driven.joints_in_camera, body.joints)
    assert np.array_equal(driven.joint_states, body.states)
    assert np.array_equal(driven.joint_confidences, body.confidences)


def test_a_held_object_stays_in_the_hand_and_slowly_shifts_in_it() -> None:
    driven = drive(recorded(source()), "drinkFromMug", seed=1)
    side = "right" if driven.person.handedness == "right" else "left"
    assert set(driven.contact) == {ContactKind[f"{side.upper()}_HAND"]}
    hand = getattr(driven.body_in_camera, f"from_{side}_hand")
    held = hand.inverse() @ driven.camera_from_object
    assert 1e-3 < np.ptp(held.translation, axis=0).max() < 0.05
    assert np.linalg.norm(np.diff(held.translation, axis=0), axis=1).max() < 0.005
    assert np.allclose(
        driven.true_joints_in_camera[:, Joint[f"HAND_{side.upper()}"]], hand.translation
    )


def test_a_long_object_points_from_hand_to_hand() -> None:
    driven = drive(recorded(source(participant=4)), "sweepFloor", seed=1)
    assert set(driven.contact) == {ContactKind.BOTH_HANDS}
    body = driven.body_in_camera
    way = body.from_left_hand.translation - body.from_right_hand.translation
    apart = np.linalg.norm(way, axis=1)
    handle = driven.camera_from_object.rotation[:, :, 2]
    aligned = np.abs(np.sum(handle * way, axis=1)) / apart
    assert np.count_nonzero(apart > 0.3) > 20
    assert aligned[apart > 0.3].min() > 0.9
    assert aligned[apart > 0.3].mean() > 0.95


def test_worn_glasses_stay_on_the_nose() -> None:
    driven = drive(recorded(source()), "putOnGlasses", seed=1)
    assert set(driven.contact) == {ContactKind.WORN}
    worn = driven.body_in_camera.from_head.inverse() @ driven.camera_from_object
    assert np.ptp(worn.translation, axis=0).max() < 1e-9
    assert worn.translation[0, 1] > 0.05


def test_the_wrist_twists_as_no_joint_shows() -> None:
    one, other = (
        drive(recorded(source(), recording=number), "drinkFromMug", seed=1) for number in (0, 1)
    )
    between = np.swapaxes(one.camera_from_object.rotation, 1, 2) @ other.camera_from_object.rotation
    apart = np.degrees(Rotation.from_matrix(between).magnitude())
    assert np.array_equal(one.joints_in_camera, other.joints_in_camera)
    assert 5.0 < apart.max() < 90.0


def grip_of(driven: Simulation) -> Rotation:
    """How the object is turned in the right hand on the average."""
    held = driven.body_in_camera.from_right_hand.inverse() @ driven.camera_from_object
    return Rotation.from_matrix(held.rotation).mean()


def test_a_person_keeps_the_grip_from_take_to_take_and_others_have_others() -> None:
    takes = [(1, 0, 0), (2, 0, 1), (1, 1, 0), (1, 2, 0), (1, 3, 0)]
    first, again, *others = (
        grip_of(
            drive(
                recorded(source(participant=body), participant=person, recording=take),
                "drinkFromMug",
                seed=1,
            )
        )
        for body, person, take in takes
    )
    assert np.degrees((first.inv() * again).magnitude()) < 8.0
    assert max(np.degrees((first.inv() * other).magnitude()) for other in others) > 12.0


def test_a_left_handed_recording_is_the_mirror_image() -> None:
    body = recorded(source(), handedness="right")
    mirrored = recorded(
        source(), joints=(body.joints * MIRROR)[:, MIRRORED_JOINTS], handedness="left"
    )
    right, left = (drive(each, "drinkFromMug", seed=1) for each in (body, mirrored))
    assert set(left.contact) == {ContactKind.LEFT_HAND}
    assert np.allclose(left.translations, right.translations * MIRROR, atol=1e-3)


def test_it_can_be_drawn() -> None:
    driven = drive(recorded(source()), "sweepFloor", seed=1)
    assert driven.draw(60).object_mask.any()
    assert 0.0 < driven.visible_fraction(60) <= 1.0


@needs_real_data
@pytest.mark.parametrize("interaction", ["drinkFromMug", "sweepFloor", "putOnGlasses"])
def test_real_movement_carries_objects_without_jumps(tmp_path: Path, interaction: str) -> None:
    bodies = import_utd_mhad(SWINGS, tmp_path / "bodies")
    for number, entry in enumerate(bodies.entries):
        body = recorded_body(bodies, entry, participant=0, recording=number)
        driven = drive(body, interaction, seed=1)
        away = np.linalg.norm(driven.true_joints_in_camera - driven.joints_in_camera, axis=2)
        assert np.median(away) < 0.02
        assert np.percentile(turns(driven), 95) < 45.0
        assert 1.4 < driven.person.height < 2.1


def skeletons(simulation: Simulation, frames: range) -> list[Message]:
    return [
        Skeletons(
            sequence=number,
            time_ns=number * 33_333_333,
            people=(person_message(simulation, frame),) if frame % 100 < 60 else (),
        )
        for number, frame in enumerate(frames)
    ]


@pytest.fixture
def bodies(tmp_path: Path) -> Dataset:
    """Three people who sweep, out of sight for 40 of 100 frames, and one who juggles."""
    writer = DatasetWriter(tmp_path / "bodies")
    for number in range(3):
        entry = DatasetEntry(
            file=f"recordings/take_{number}.mcap",
            interaction="sweepFloor",
            participant=f"s{number}",
        )
        writer.add_recording(entry, skeletons(source(participant=number), range(100, 280)))
    entry = DatasetEntry(file="recordings/take_3.mcap", interaction="juggle", participant="s0")
    writer.add_recording(entry, skeletons(source(), range(100, 160)))
    return writer.finish({})


def test_every_fitting_recording_becomes_a_labelled_one(tmp_path: Path, bodies: Dataset) -> None:
    driven = generate_driven(
        tmp_path / "driven", bodies, DrivenSettings(None, 4, images=False), lambda: None
    )
    assert [(e.interaction, e.participant, e.object) for e in driven.entries] == [
        ("sweepFloor", f"s{number}", "broom") for number in range(3)
    ]
    frames = load_frames(driven.path(driven.entries[0]), "broom")
    original = load_frames(bodies.path(bodies.entries[0]), None)
    assert len(frames) == 60
    assert frames[7].people[0].joints == original[7].people[0].joints
    assert all(frame.label is not None and frame.label.contact == "both_hands" for frame in frames)
    assert np.isfinite(labelled_sequence(driven, driven.entries[0]).translations).all()


def test_chosen_objects_go_with_every_recording(bodies: Dataset) -> None:
    pairs = pairs_for(bodies, ["drinkFromMug", "putOnGlasses"])
    assert len(pairs) == 8
    assert {interaction for _, interaction in pairs} == {"drinkFromMug", "putOnGlasses"}


def test_where_nothing_fits_the_choice_is_asked_for(bodies: Dataset) -> None:
    jugglers = Dataset(bodies.folder, bodies.entries[3:])
    with pytest.raises(DatasetError, match="choose with --interactions"):
        pairs_for(jugglers, None)


def test_a_recording_without_a_body_is_refused(tmp_path: Path) -> None:
    writer = DatasetWriter(tmp_path / "empty")
    entry = DatasetEntry(file="recordings/a.mcap", interaction="sweepFloor", participant="s0")
    writer.add_recording(entry, [Skeletons(sequence=0, time_ns=0)])
    with pytest.raises(DatasetError, match="all twenty joints"):
        recorded_body(writer.finish({}), entry, participant=0, recording=0)


def test_bones_are_measured_on_both_sides() -> None:
    lengths = bone_lengths(source().true_joints_in_camera)
    assert lengths.shape == (19,)
    assert np.allclose(lengths, lengths[np.array(MIRRORED_JOINTS[1:]) - 1])

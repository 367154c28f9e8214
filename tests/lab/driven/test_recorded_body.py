"""Real movement with a simulated object: what is measured, what is true, and what is held."""

from pathlib import Path

import numpy as np
import pytest
from inhand_lab.driven.dataset import recorded_body
from inhand_lab.driven.recorded_body import drive
from inhand_lab.geometry.transforms import MIRROR
from inhand_lab.importers.utd_mhad import import_utd_mhad
from inhand_lab.motions.performance import ContactKind
from inhand_lab.world.simulation import Simulation
from inhand_schemas.joints import MIRRORED_JOINTS, Joint
from inhand_tracker.geometry.arrays import Array
from real_data import DATA
from recorded_bodies import recorded, source
from scipy.spatial.transform import Rotation

REAL = DATA / "utd-mhad"
SWINGS = [REAL / f"a{action}_s{person}_t1_skeleton.mat" for action in (15, 16) for person in (1, 6)]

needs_real_data = pytest.mark.skipif(not REAL.is_dir(), reason=f"no real data: {REAL}")


def turns(simulation: Simulation) -> Array:
    """The object's turn (T-1,) from each frame to the next, degrees."""
    rotations = Rotation.from_matrix(simulation.camera_from_object.rotation)
    return np.asarray(np.degrees((rotations[:-1].inv() * rotations[1:]).magnitude()))


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

"""People who use nothing stand and walk as people do."""

import numpy as np
import pytest
from inhand_lab.datasets.observations import observe_simulation
from inhand_lab.world.idle_people import IDLENESS, Idleness, simulate_idle, watch_idle
from inhand_schemas.joints import PARENTS, Joint


@pytest.mark.parametrize("idleness", IDLENESS)
def test_the_same_seed_shows_the_same_person_and_another_seed_another(idleness: str) -> None:
    one, same = (watch_idle(idleness, 3, 1, frames=60) for _ in range(2))
    np.testing.assert_array_equal(one.joints, same.joints)
    assert not np.allclose(one.joints, watch_idle(idleness, 3, 2, frames=60).joints)


@pytest.mark.parametrize("idleness", IDLENESS)
def test_trunks_keep_their_lengths_and_stay_before_the_camera(idleness: str) -> None:
    joints = watch_idle(idleness, 0, 4, frames=300).joints
    for joint in (Joint.SPINE, Joint.SHOULDER_CENTER, Joint.HEAD):
        lengths = np.linalg.norm(joints[:, joint] - joints[:, PARENTS[joint]], axis=1)
        assert np.nanstd(lengths) < 0.05
    hips = joints[:, Joint.HIP_CENTER]
    assert np.nanmin(hips[:, 2]) > 1.5
    assert np.nanmax(np.abs(hips[:, 0])) < 2.0


def test_who_walks_lifts_one_foot_after_the_other_and_who_stands_none() -> None:
    def lifted(idleness: str) -> np.ndarray:
        joints = watch_idle(idleness, 1, 5, frames=300).joints
        return joints[:, Joint.ANKLE_LEFT, 1] - joints[:, Joint.ANKLE_RIGHT, 1]

    walking, standing = lifted("walkOnSpot"), lifted("stand")
    assert np.nanstd(walking) > 3.0 * np.nanstd(standing)
    signs = np.sign(walking[np.abs(walking - np.nanmean(walking)) > 0.04])
    assert np.count_nonzero(np.diff(signs)) > 8


def test_only_gestures_and_fidgets_bring_hands_above_the_chest() -> None:
    def highest(idleness: str) -> float:
        joints = np.concatenate([watch_idle(idleness, n, 6).joints for n in range(3)])
        hands = joints[:, [Joint.HAND_LEFT, Joint.HAND_RIGHT], 1]
        return float(np.nanmax(joints[:, [Joint.SHOULDER_CENTER], 1] - hands))

    assert highest("stand") < 0.0
    assert highest("gesture") > 0.0
    assert highest("fidget") > 0.0


@pytest.mark.parametrize("idleness", IDLENESS)
def test_idle_people_are_drawn_where_their_skeletons_are_and_no_object_is(
    idleness: Idleness,
) -> None:
    simulation = simulate_idle(idleness, 1, 7, frames=4)
    drawing = simulation.draw(3)
    assert not drawing.object_mask.any()
    assert simulation.render(3).visible_fraction == 0.0
    hips = simulation.true_joints_in_camera[3, Joint.HIP_CENTER]
    camera = simulation.intrinsics
    column, row = (
        round(float(focal * along / hips[2] + centre))
        for focal, along, centre in (
            (camera.fx, hips[0], camera.cx),
            (camera.fy, hips[1], camera.cy),
        )
    )
    depth = drawing.canvas.depth_in_millimetres()[row, column] / 1000.0
    assert hips[2] - 0.3 < depth < hips[2] + 0.05


def test_a_drawn_idle_person_is_observed_with_the_watched_skeleton_and_what_is_needed() -> None:
    watched = watch_idle("gesture", 2, 8, frames=3)
    simulation = simulate_idle("gesture", 2, 8, frames=3)
    for number, seen in enumerate(observe_simulation(simulation, ("colour", "depth"))):
        np.testing.assert_array_equal(seen.joints, watched.joints[number])
        assert seen.time_ns == watched.times_ns[number]
        assert seen.image is not None
        assert seen.image.colour is not None
        assert seen.image.depth is not None
        assert seen.image.grey is None
    assert all(seen.image is None for seen in observe_simulation(simulation))

"""Joints of other conventions as ours."""

import re
from dataclasses import replace

import numpy as np
import pytest
from foreign_skeletons import TABLES, person_of, seen, standing_before_camera
from hypothesis import given, settings
from hypothesis import strategies as st
from inhand_capture.estimation.coco import PLACES
from inhand_capture.estimation.conventions import as_kinect
from inhand_capture.estimation.parameters import DEFAULT_LIFTING
from inhand_lab.importers.coco import COCO
from inhand_lab.importers.joint_tables import (
    INFERRED,
    MISSING,
    TRACKED,
    JointAhead,
    JointMean,
    JointTable,
    Place,
    our_joints,
)
from inhand_lab.importers.parameters import DEFAULT_IMPORT
from inhand_lab.importers.utd_mhad import read_trial
from inhand_lab.importers.zed import ZED
from inhand_schemas.joints import JOINT_NAMES, MIRRORED_JOINTS, Joint
from inhand_tracker.body.skeleton import part_lengths
from real_data import DATA, needs_real_data
from running_rig import ROOT
from scipy.spatial.transform import Rotation

FEET = (Joint.FOOT_LEFT, Joint.FOOT_RIGHT)
each_table = pytest.mark.parametrize("table", TABLES, ids=lambda table: table.name)
metres = st.floats(-5.0, 5.0)
turns = st.tuples(metres, metres, metres).map(Rotation.from_rotvec)


@each_table
def test_a_standing_person_comes_out_as_a_kinect_sees_them(table: JointTable) -> None:
    ours = our_joints(table, seen(person_of(table)[None])).places[0]
    errors = np.linalg.norm(ours - standing_before_camera(), axis=1)
    # COCO's joints are others in the same body, and the figure stands for both.
    assert errors.max() < 0.08


@each_table
@given(turn=turns, shift=st.tuples(metres, metres, metres))
@settings(max_examples=50, deadline=None)
def test_turns_and_shifts_are_kept_and_so_are_the_lengths_of_bones(
    table: JointTable, turn: Rotation, shift: tuple[float, float, float]
) -> None:
    theirs = person_of(table)
    here = our_joints(table, seen(theirs[None])).places[0]
    there = our_joints(table, seen((turn.apply(theirs) + shift)[None])).places[0]
    np.testing.assert_allclose(there, turn.apply(here) + shift, atol=1e-9)
    np.testing.assert_allclose(part_lengths(there), part_lengths(here), atol=1e-9)


@each_table
@given(stretch=st.floats(0.7, 1.2), lean=st.floats(-0.5, 0.5))
@settings(max_examples=50, deadline=None)
def test_left_is_left_and_up_is_up(table: JointTable, stretch: float, lean: float) -> None:
    theirs = stretch * Rotation.from_rotvec([lean, 0.0, 0.0]).apply(person_of(table))
    ours = our_joints(table, seen(theirs[None])).places[0]
    for left, right in zip(Joint, MIRRORED_JOINTS, strict=True):
        if left.name.endswith("LEFT") and np.isfinite(ours[left]).all():
            # The person faces the camera, so that their left is at the image's right.
            assert ours[left, 0] > ours[right, 0] + 0.05
    upwards = [Joint.ANKLE_LEFT, Joint.KNEE_LEFT, Joint.HIP_LEFT, Joint.HIP_CENTER, Joint.SPINE]
    upwards += [Joint.SHOULDER_CENTER, Joint.HEAD]
    assert (np.diff(ours[upwards, 1]) < 0.0).all()


@each_table
def test_every_place_is_a_mean_of_joints_that_the_convention_has(table: JointTable) -> None:
    assert len(set(table.joints)) == len(table.joints)
    places = [place for candidates in table.candidates.values() for place in candidates]
    for mean in (*(place for place in places if isinstance(place, JointMean)), *table.front):
        assert set(mean.weights) <= set(table.joints)
        assert sum(mean.weights.values()) == pytest.approx(1.0, abs=1e-12)


@each_table
def test_every_joint_of_ours_has_a_place(table: JointTable) -> None:
    assert set(table.candidates) == set(Joint)


def test_both_sides_of_every_table_are_alike() -> None:
    def other_side(name: str) -> str:
        sides = {"left": "right", "right": "left", "Left": "Right", "Right": "Left"}
        sides |= {"LEFT": "RIGHT", "RIGHT": "LEFT"}
        return re.sub("|".join(sides), lambda side: sides[side[0]], name)

    for table in TABLES:
        for joint, candidates in table.candidates.items():
            mirrored = tuple(
                JointMean({other_side(n): w for n, w in one.weights.items()}, one.inferred)
                if isinstance(one, JointMean)
                else replace(one, joint=other_side(one.joint))
                for one in candidates
            )
            assert table.candidates[Joint(MIRRORED_JOINTS[joint])] == mirrored


class TestStates:
    def test_a_place_is_as_well_tracked_as_the_worst_of_its_joints(self) -> None:
        theirs = seen(person_of(ZED)[None])
        navel, wrist = ZED.joints.index("NAVAL_SPINE"), ZED.joints.index("LEFT_WRIST")
        theirs.states[0, navel], theirs.confidences[0, navel] = INFERRED, 0.2
        theirs.states[0, wrist], theirs.places[0, wrist] = MISSING, np.nan
        ours = our_joints(ZED, theirs)
        assert ours.states[0, Joint.HIP_CENTER] == ours.states[0, Joint.SPINE] == INFERRED
        assert ours.confidences[0, Joint.SPINE] == 0.2
        assert ours.states[0, Joint.WRIST_LEFT] == MISSING
        assert ours.states[0, Joint.HAND_LEFT] == TRACKED

    def test_a_head_without_ears_is_inferred_by_what_is_there(self) -> None:
        for table, ear in ((ZED, "LEFT_EAR"), (COCO, "left_ear")):
            theirs = seen(person_of(table)[None])
            theirs.places[0, table.joints.index(ear)] = np.nan
            ours = our_joints(table, theirs)
            assert ours.states[0, Joint.HEAD] == INFERRED
            head = standing_before_camera()[Joint.HEAD]
            assert np.linalg.norm(ours.places[0, Joint.HEAD] - head) < 0.1

    def test_what_coco_lacks_is_inferred(self) -> None:
        (states,) = our_joints(COCO, seen(person_of(COCO)[None])).states
        lacking = {Joint.HIP_CENTER, Joint.SPINE, Joint.SHOULDER_CENTER}
        lacking |= {Joint.HAND_LEFT, Joint.HAND_RIGHT, Joint.FOOT_LEFT, Joint.FOOT_RIGHT}
        assert {joint for joint in Joint if states[joint] == INFERRED} == lacking
        assert MISSING not in states

    def test_feet_ahead_of_ankles_are_missing_where_nothing_says_what_is_ahead(self) -> None:
        theirs = seen(np.repeat(person_of(COCO)[None], 3, axis=0))
        theirs.places[0, COCO.joints.index("left_ankle")] = np.nan
        theirs.places[1, COCO.joints.index("right_hip")] = np.nan
        theirs.places[2, :, 0] = 0.0  # a body of no width
        states = our_joints(COCO, theirs).states[:, list(FEET)]
        np.testing.assert_array_equal(states != MISSING, [[False, True], [False] * 2, [False] * 2])


def test_coco_gives_what_capture_makes_of_a_network_of_coco() -> None:
    places = np.random.default_rng(5).normal(size=(17, 3))
    network, states = np.full((20, 3), np.nan), np.zeros(20, np.uint8)
    for joint, points in PLACES.items():
        network[joint], states[joint] = places[list(points)].mean(axis=0), TRACKED
    expected, expected_states = as_kinect(network, states, DEFAULT_LIFTING)
    ours = our_joints(COCO, seen(places[None]))
    # Its hands lie beyond the wrists by a share of the trunk, which is no mean.
    same = [joint for joint in Joint if not joint.name.startswith("HAND")]
    np.testing.assert_allclose(ours.places[0][same], expected[same], atol=1e-12)
    np.testing.assert_array_equal(ours.states[0][same], expected_states[same])


@needs_real_data
def test_the_trunks_shares_are_those_of_utd_mhad() -> None:
    shares = []
    for path in sorted((DATA / "utd-mhad").glob("*_t1_skeleton.mat")):
        joints = read_trial(path).joints_in_camera
        hips = joints[:, [Joint.HIP_LEFT, Joint.HIP_RIGHT]].mean(axis=1)
        trunk = joints[:, Joint.SHOULDER_CENTER] - hips
        for joint in (Joint.HIP_CENTER, Joint.SPINE):
            along = np.sum((joints[:, joint] - hips) * trunk, axis=1) / np.sum(trunk**2, axis=1)
            shares.append(along[np.isfinite(along)])
    hip_centre, spine = (np.median(np.concatenate(shares[i::2])) for i in (0, 1))
    assert hip_centre == pytest.approx(DEFAULT_IMPORT.hip_centre_share, abs=0.002)
    assert spine == pytest.approx(DEFAULT_IMPORT.spine_share, abs=0.002)


def written(place: Place) -> str:
    """A place as the page's table has it, with * where it is inferred."""
    if isinstance(place, JointAhead):
        return f"`{place.joint}`, {place.share:g} of the trunk ahead*"
    named = [
        f"`{name}`" if weight == 1.0 else f"{weight:.3g} `{name}`"
        for name, weight in place.weights.items()
    ]
    return " + ".join(named).replace("+ -", "− ") + "*" * place.inferred


def table_row(joint: Joint) -> str:
    """The row of the page's table that shows a joint's candidates, best first."""
    cells = ["; else ".join(map(written, table.candidates[joint])) for table in TABLES]
    return f"| {' | '.join((JOINT_NAMES[joint], *cells))} |"


def test_the_page_shows_the_tables_as_they_are() -> None:
    page = (ROOT / "docs" / "foreign_skeletons.md").read_text()
    for joint in Joint:
        if not joint.name.endswith("RIGHT"):
            assert table_row(joint) in page.splitlines()

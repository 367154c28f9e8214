"""Left and right that a network exchanges."""

import numpy as np
import pytest
from inhand_capture.estimation.found_person import FoundPerson
from inhand_capture.estimation.lifting import Lifted
from inhand_capture.estimation.sides import Sides
from inhand_schemas.joints import MIRRORED_JOINTS, Joint
from numpy.typing import NDArray
from posed_person import pixels_of, seen, standing

FRAME_S = 1.0 / 30.0
ARMS = {"SHOULDER", "ELBOW", "WRIST", "HAND"}


def exchanged(person: FoundPerson) -> FoundPerson:
    order = np.array(MIRRORED_JOINTS)
    return FoundPerson(person.pixels[order], person.depths[order], person.visibilities[order])


def test_sides_that_are_exchanged_for_some_frames_are_exchanged_back() -> None:
    sides, person = Sides(), seen(standing())
    for wrong in (False, True, True, False, True):
        kept = sides.kept(exchanged(person) if wrong else person, FRAME_S)
        np.testing.assert_array_equal(kept.pixels, person.pixels)


def test_arms_that_alone_are_exchanged_are_exchanged_back() -> None:
    sides, person = Sides(), seen(standing())
    arms = [int(joint) for joint in Joint if joint.name.split("_")[0] in ARMS]
    order = np.arange(len(Joint))
    order[arms] = np.array(MIRRORED_JOINTS)[arms]
    wrong = FoundPerson(person.pixels[order], person.depths[order], person.visibilities[order])
    sides.kept(person, FRAME_S)
    np.testing.assert_array_equal(sides.kept(wrong, FRAME_S).pixels, person.pixels)


def test_a_frame_with_both_sides_in_one_place_does_not_let_sides_change_after_it() -> None:
    sides, person = Sides(), seen(standing())
    middle = 0.5 * (person.pixels + exchanged(person).pixels)
    for _ in range(5):
        sides.kept(person, FRAME_S)
    sides.kept(FoundPerson(middle, np.zeros(20), person.visibilities), FRAME_S)
    for _ in range(10):
        kept = sides.kept(exchanged(person), FRAME_S)
        np.testing.assert_array_equal(kept.pixels, person.pixels)


def test_a_network_without_depths_has_its_sides_kept_too() -> None:
    sides, person = Sides(), seen(standing(), depths=False)
    sides.kept(person, FRAME_S)
    np.testing.assert_array_equal(sides.kept(exchanged(person), FRAME_S).pixels, person.pixels)


def test_a_network_that_goes_on_about_it_is_believed() -> None:
    sides, wrong = Sides(), exchanged(seen(standing()))
    sides.kept(seen(standing()), FRAME_S)
    for _ in range(30):
        kept = sides.kept(wrong, FRAME_S)
    np.testing.assert_array_equal(kept.pixels, wrong.pixels)


@pytest.mark.parametrize("depths", [True, False])
@pytest.mark.parametrize("steps", [31, 32])
def test_somebody_who_turns_round_keeps_their_sides(*, depths: bool, steps: int) -> None:
    sides, there = Sides(), np.array([0.0, 0.0, 2.5])
    for turn in np.linspace(0.0, np.pi, steps):
        joints = standing() - there
        cosine, sine = np.cos(turn), np.sin(turn)
        turned = joints @ np.array([[cosine, 0.0, -sine], [0.0, 1.0, 0.0], [sine, 0.0, cosine]])
        person = seen(turned + there, depths=depths)
        np.testing.assert_array_equal(sides.kept(person, FRAME_S).pixels, person.pixels)
    assert pixels_of(turned + there)[4, 0] < pixels_of(standing())[4, 0]


def as_lifted(joints: NDArray[np.float64]) -> Lifted:
    states = np.where(np.isfinite(joints[:, 0]), 2, 0).astype(np.uint8)
    return Lifted(joints, states, joints)


def test_toes_that_point_backwards_say_that_left_is_right() -> None:
    truth, order = standing(), np.array(MIRRORED_JOINTS)
    assert not Sides().are_wrong(as_lifted(truth), 0.0)
    sides = Sides()
    assert sides.are_wrong(as_lifted(truth[order]), 0.0)
    assert not sides.are_wrong(as_lifted(truth), FRAME_S)


def test_one_frame_s_toes_do_not_contradict_many() -> None:
    truth, order, sides = standing(), np.array(MIRRORED_JOINTS), Sides()
    for _ in range(10):
        assert not sides.are_wrong(as_lifted(truth), FRAME_S)
    assert not sides.are_wrong(as_lifted(truth[order]), FRAME_S)
    assert any(sides.are_wrong(as_lifted(truth[order]), FRAME_S) for _ in range(10))


def test_a_network_that_goes_on_about_it_is_not_believed_against_the_toes() -> None:
    sides, wrong = Sides(), exchanged(seen(standing()))
    sides.kept(seen(standing()), FRAME_S)
    for _ in range(60):
        kept = sides.kept(wrong, FRAME_S)
        assert not sides.are_wrong(as_lifted(standing()), FRAME_S)
    np.testing.assert_array_equal(kept.pixels, seen(standing()).pixels)


def test_toes_that_are_not_seen_say_nothing() -> None:
    hidden = standing()[np.array(MIRRORED_JOINTS)]
    hidden[[Joint.FOOT_LEFT, Joint.FOOT_RIGHT]] = np.nan
    assert not Sides().are_wrong(as_lifted(hidden), 0.0)

"""Left and right that a network exchanges."""

import numpy as np
from inhand_capture.estimation.found_person import FoundPerson
from inhand_capture.estimation.sides import Sides
from inhand_schemas.joints import MIRRORED_JOINTS
from posed_person import pixels_of, seen, standing

FRAME_S = 1.0 / 30.0


def exchanged(person: FoundPerson) -> FoundPerson:
    order = np.array(MIRRORED_JOINTS)
    return FoundPerson(person.pixels[order], person.depths[order], person.visibilities[order])


def test_sides_that_are_exchanged_for_some_frames_are_exchanged_back() -> None:
    sides, person = Sides(), seen(standing())
    for wrong in (False, True, True, False, True):
        kept = sides.kept(exchanged(person) if wrong else person, FRAME_S)
        np.testing.assert_array_equal(kept.pixels, person.pixels)


def test_a_network_that_goes_on_about_it_is_believed() -> None:
    sides, wrong = Sides(), exchanged(seen(standing()))
    sides.kept(seen(standing()), FRAME_S)
    for _ in range(30):
        kept = sides.kept(wrong, FRAME_S)
    np.testing.assert_array_equal(kept.pixels, wrong.pixels)


def test_somebody_who_turns_round_keeps_their_sides() -> None:
    sides, there = Sides(), np.array([0.0, 0.0, 2.5])
    for turn in np.linspace(0.0, np.pi, 31):
        joints = standing() - there
        cosine, sine = np.cos(turn), np.sin(turn)
        turned = joints @ np.array([[cosine, 0.0, -sine], [0.0, 1.0, 0.0], [sine, 0.0, cosine]])
        person = seen(turned + there)
        np.testing.assert_array_equal(sides.kept(person, FRAME_S).pixels, person.pixels)
    assert pixels_of(turned + there)[4, 0] < pixels_of(standing())[4, 0]

"""People: who they are."""

import numpy as np
import pytest
from inhand_lab.people.person import HEIGHT_RANGE, Carriage, sample_person, stature_of


def test_the_same_seed_and_number_are_the_same_person() -> None:
    assert sample_person(3, 5) == sample_person(3, 5)


def test_other_seeds_and_numbers_are_other_people() -> None:
    people = {sample_person(seed, number).height for seed in range(3) for number in range(5)}
    assert len(people) == 15


def test_a_crowd_is_like_the_published_one() -> None:
    crowd = [sample_person(1, number) for number in range(800)]
    for sex, mean in (("female", 1.628), ("male", 1.756)):
        heights = [person.height for person in crowd if person.sex == sex]
        assert np.mean(heights) == pytest.approx(mean, abs=0.015)
        assert np.std(heights) == pytest.approx(0.066, abs=0.012)
    assert all(HEIGHT_RANGE[0] <= person.height <= HEIGHT_RANGE[1] for person in crowd)
    left_handed = np.mean([person.handedness == "left" for person in crowd])
    assert 0.06 < left_handed < 0.14


def test_the_segments_add_up_to_the_stature() -> None:
    for number in range(20):
        person = sample_person(2, number)
        assert stature_of(person.proportions) == pytest.approx(person.height, abs=1e-9)


def test_heads_differ_less_than_statures() -> None:
    crowd = [sample_person(1, number) for number in range(400)]
    heads = np.array([person.proportions.head_half_width for person in crowd])
    heights = np.array([person.height for person in crowd])
    slope = np.polyfit(np.log(heights), np.log(heads), 1)[0]
    assert 0.0 < slope < 0.7


def test_varied_people_have_the_usual_bodies_and_carry_them_each_in_a_way_of_their_own() -> None:
    usual = [sample_person(6, number) for number in range(12)]
    varied = [sample_person(6, number, "varied") for number in range(12)]
    for one, other in zip(usual, varied, strict=True):
        assert one.proportions == other.proportions
        assert (one.handedness, one.appearance) == (other.handedness, other.appearance)
    assert {person.carriage for person in usual} == {Carriage()}
    for habit in vars(Carriage()):
        assert len({getattr(person.carriage, habit) for person in varied}) == 12
    for habit in ("tempo", "amplitude", "elbow_flare", "restlessness", "grip_turn", "grip_tilt"):
        differing, alike = (
            np.ptp([getattr(person.manner, habit) for person in people])
            for people in (varied, usual)
        )
        assert differing > alike

"""A recording whose rotations are written in another way than all others is named."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.training.rotation_checks import check_rotations
from inhand_lab.world.interactions import INTERACTIONS
from inhand_lab.world.simulation import Simulation, simulate
from inhand_schemas.joints import Joint
from inhand_tracker.geometry import rotations
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from scipy.spatial.transform import Rotation
from waving import entry_of, waving

NORMAL = np.array([1.0, 0.0, 0.0])
GRIP = Rotation.from_euler("xyz", (20, -35, 50), degrees=True)
Change = Callable[[np.ndarray], np.ndarray]


def people(count: int = 4) -> list[LabelledSequence]:
    """People who wave a box, each held a little differently and seen from elsewhere."""
    sequences = []
    for seed in range(count):
        joints, places, turns = waving(60, seed)
        view = Rotation.from_euler("y", 25.0 * seed, degrees=True)
        own = GRIP * Rotation.from_euler("xy", (4 * seed, -5 * seed), degrees=True)
        held = view * Rotation.from_quat(turns, scalar_first=True) * own
        sequences.append(
            LabelledSequence(
                f"p{seed}",
                False,
                view.apply(joints.reshape(-1, 3)).reshape(joints.shape),
                view.apply(places),
                held.as_quat(scalar_first=True),
            )
        )
    return sequences


def check(sequences: list[LabelledSequence], *changed: int, change: Change) -> None:
    for number in changed:
        one = sequences[number]
        sequences[number] = replace(one, rotations=change(one.rotations))
    check_rotations([entry_of(f"p{n}") for n in range(len(sequences))], sequences, NORMAL)


def to_xyzw(turns: np.ndarray) -> np.ndarray:
    return turns[:, [1, 2, 3, 0]]


@pytest.mark.parametrize("number", range(4))
@pytest.mark.parametrize("count", [4, 7])
def test_the_only_recording_in_another_order_is_named(number: int, count: int) -> None:
    with pytest.raises(DatasetError, match=rf"p{number}\.mcap: 'box' .*\(x, y, z, w\): write"):
        check(people(count), number, change=to_xyzw)


def test_two_of_seven_in_another_order_are_refused() -> None:
    with pytest.raises(DatasetError, match=r"p[25]\.mcap: 'box' .*\(x, y, z, w\): write"):
        check(people(7), 2, 5, change=to_xyzw)


def test_the_only_recording_of_inverse_rotations_is_named() -> None:
    with pytest.raises(DatasetError, match=r"p2\.mcap: 'box' .*write camera_from_object"):
        check(people(), 2, change=rotations.conjugate)


def test_a_left_handed_person_in_another_order_is_named() -> None:
    sequences = people()
    mirrored = replace(sequences[1], left_handed=True).right_handed(NORMAL)
    sequences[1] = replace(mirrored, left_handed=True)
    check_rotations([entry_of(f"p{n}") for n in range(4)], sequences, NORMAL)
    with pytest.raises(DatasetError, match=r"p1\.mcap: 'box' .*\(x, y, z, w\)"):
        check(sequences, 1, change=to_xyzw)


def test_signs_of_quaternions_may_flip_freely() -> None:
    signs = np.where(np.random.default_rng(0).random((60, 1)) < 0.5, -1.0, 1.0)
    check(people(), 0, 2, change=lambda turns: signs * turns)


def test_who_holds_an_object_the_other_way_round_is_no_mistake() -> None:
    for axis in ("x", "y", "z"):
        turned = Rotation.from_euler(axis, 180, degrees=True).as_quat(scalar_first=True)
        check(people(), 1, change=lambda turns, t=turned: rotations.multiply(turns, t))


def test_frames_without_body_or_label_and_two_recordings_say_nothing() -> None:
    sequences = people()
    sequences[3].joints[:40, 5] = np.nan
    sequences[2].rotations[10:30] = np.nan
    check(sequences, change=to_xyzw)
    check(people(2), 1, change=to_xyzw)
    empty = replace(sequences[0], rotations=np.full((60, 4), np.nan))
    check([*sequences[1:], empty], change=to_xyzw)


def test_all_recordings_in_another_order_are_refused_by_where_hands_hold() -> None:
    sequences = []
    for one in people():
        away = rotations.rotate(one.rotations, np.array([0.1, 0.2, -0.1]))
        sequences.append(replace(one, translations=one.joints[:, Joint.HAND_RIGHT] + away))
    check(list(sequences), change=to_xyzw)
    with pytest.raises(
        DatasetError, match=r"p0\.mcap and others: hands stay .*\(x, y, z, w\): wri"
    ):
        check(sequences, 0, 1, 2, 3, change=to_xyzw)


def test_hands_that_stay_within_a_centimetre_hold_the_object_as_it_should_be() -> None:
    # By true joints of these three another reading makes them stay within half of it.
    shown = [simulate("recordVideo", person, seed=17, frames=150) for person in (0, 1, 3)]
    sequences = [with_joints(one, one.true_joints_in_camera) for one in shown]
    check_rotations([entry_of(f"p{n}") for n in range(3)], sequences, NORMAL)


def with_joints(shown: Simulation, joints: np.ndarray) -> LabelledSequence:
    left_handed = shown.person.handedness == "left"
    return LabelledSequence(
        str(shown.participant), left_handed, joints, shown.translations, shown.rotations
    )


@pytest.mark.long
def test_no_simulated_object_is_refused_and_most_misread_ones_are() -> None:
    missed = []
    for interaction in INTERACTIONS:
        shown = [simulate(interaction, person, seed=11, frames=150) for person in range(4)]
        sequences = [with_joints(one, one.true_joints_in_camera) for one in shown]
        normal = np.array(shown[0].object_model.mirror_normal)
        check_rotations([entry_of(f"p{n}") for n in range(4)], sequences, normal)
        sequences = [with_joints(one, one.joints_in_camera) for one in shown]
        check_rotations([entry_of(f"p{n}") for n in range(4)], sequences, normal)
        sequences[1] = replace(sequences[1], rotations=to_xyzw(sequences[1].rotations))
        with suppress(DatasetError):
            check_rotations([entry_of(f"p{n}") for n in range(4)], sequences, normal)
            missed.append(interaction)
    assert len(missed) <= 2

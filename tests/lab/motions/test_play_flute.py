"""playFlute: blown at the lips, held to the right of the face with both hands."""

import numpy as np
import pytest
from inhand_lab.motions.performance import ContactKind, mouth
from inhand_lab.objects.flute import EMBOUCHURE, FLUTE_HALF_LENGTH, TUBE_RADIUS
from inhand_lab.people.kinematics import place_trunk
from inhand_tracker.geometry.arrays import Array
from performers import FRAME_RATE, performed

HOLE = np.array([0.0, EMBOUCHURE, TUBE_RADIUS])
FOOT = np.array([0.0, FLUTE_HALF_LENGTH, 0.0])
everybody = pytest.mark.parametrize("participant", range(10))


def gap_to_lips(participant: int) -> Array:
    person, performance, _ = performed("playFlute", participant)
    lips = mouth(person, place_trunk(person, performance.posture))
    return np.linalg.norm(performance.world_from_object.apply(HOLE) - lips, axis=1)


@everybody
def test_it_is_played_more_than_once_with_pauses_between(participant: int) -> None:
    _, performance, _ = performed("playFlute", participant)
    played = gap_to_lips(participant) < 0.02
    assert np.count_nonzero(np.diff(played.astype(int)) == 1) >= 2
    assert played.sum() > 1.5 * FRAME_RATE
    assert (performance.contact[played] == ContactKind.BOTH_HANDS).all()


@everybody
def test_it_points_to_the_right_of_the_face_while_played(participant: int) -> None:
    _, performance, body = performed("playFlute", participant)
    played = gap_to_lips(participant) < 0.02
    foot = body.from_head.inverse().apply(performance.world_from_object.apply(FOOT))[played]
    assert foot[:, 0].min() > 0.45
    assert foot[:, 2].max() < 0.0


@everybody
def test_the_player_sways(participant: int) -> None:
    _, _, body = performed("playFlute", participant)
    played = gap_to_lips(participant) < 0.02
    assert np.ptp(body.from_head.translation[played], axis=0).max() > 0.02

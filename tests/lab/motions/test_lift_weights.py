"""liftWeights: a level bar that goes from the stool to hanging arms and up to the chest."""

import numpy as np
import pytest
from inhand_lab.motions.performance import ContactKind
from inhand_lab.objects.barbell import PLATE_RADIUS, barbell
from inhand_schemas.joints import Joint
from performers import angles_at, performed
from scipy.signal import find_peaks

everybody = pytest.mark.parametrize("participant", range(10))


@everybody
def test_the_bar_is_curled_more_than_once_by_bending_the_elbows(participant: int) -> None:
    _, performance, body = performed("liftWeights", participant)
    height = performance.world_from_object.translation[:, 2]
    shoulder = body.joints[:, Joint.SHOULDER_RIGHT, 2]
    tops, _ = find_peaks(height, prominence=0.25)
    assert len(tops) >= 2
    assert np.abs(height - shoulder)[tops].max() < 0.20
    elbow = angles_at(body.joints, Joint.SHOULDER_RIGHT, Joint.ELBOW_RIGHT, Joint.WRIST_RIGHT)
    assert elbow[tops].max() < 80.0
    between = slice(tops[0], tops[-1])
    assert elbow[between].max() > 140.0


@everybody
def test_the_bar_stays_level_in_the_hands(participant: int) -> None:
    _, performance, _ = performed("liftWeights", participant)
    held = performance.contact == ContactKind.BOTH_HANDS
    slope = np.degrees(np.arcsin(performance.world_from_object.rotation[held, 2, 0]))
    assert np.abs(slope).max() < 6.0


@everybody
def test_the_bar_is_taken_in_a_stoop_to_the_right(participant: int) -> None:
    _, performance, body = performed("liftWeights", participant)
    taken = int(np.argmax(performance.contact == ContactKind.BOTH_HANDS))
    head = body.joints[:, Joint.HEAD]
    assert head[taken, 2] < head[0, 2] - 0.30
    assert performance.world_from_object.translation[0, 0] > 0.20
    ahead = body.from_pelvis.rotation[taken, :, 1]
    assert np.degrees(np.arctan2(ahead[0], ahead[1])) > 30.0


def test_a_turn_about_its_axis_and_end_for_end_leave_the_bar_as_it_is() -> None:
    vertices = barbell().vertices
    assert {symmetry.order for symmetry in barbell().symmetries} == {0, 2}
    ends = np.unique(np.round(np.abs(vertices[:, 0]), 6))
    for side in (-1.0, 1.0):
        assert np.allclose(
            np.unique(np.round(np.abs(vertices[side * vertices[:, 0] > 0, 0]), 6)), ends
        )
    assert np.linalg.norm(vertices[:, 1:], axis=1).max() == pytest.approx(PLATE_RADIUS, abs=1e-6)

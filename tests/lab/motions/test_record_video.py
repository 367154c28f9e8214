"""recordVideo: both hands hold the camera up before the face and pan it."""

import numpy as np
import pytest
from inhand_lab.motions.performance import ContactKind
from performers import FRAME_RATE, performed

PARTICIPANTS = range(10)


@pytest.mark.parametrize("participant", PARTICIPANTS)
def test_filming_is_done_with_both_hands_before_and_just_above_the_face(participant: int) -> None:
    _, performance, body = performed("recordVideo", participant)
    camera = performance.world_from_object
    height = camera.translation[:, 2] - body.from_head.translation[:, 2]
    up = height > 0.0
    assert up.sum() > 3 * FRAME_RATE
    assert (performance.contact[up] == ContactKind.BOTH_HANDS).all()
    assert height.max() < 0.15
    distance = np.linalg.norm(camera.translation - body.from_head.translation, axis=1)
    assert distance[up].min() > 0.15
    assert distance[up].max() < 0.45


@pytest.mark.parametrize("participant", PARTICIPANTS)
def test_the_camera_pans_and_is_held_nearly_level(participant: int) -> None:
    _, performance, body = performed("recordVideo", participant)
    camera = performance.world_from_object
    up = camera.translation[:, 2] > body.from_head.translation[:, 2]
    ahead = camera.rotation[up, :, 1]
    heading = np.arctan2(-ahead[:, 0], ahead[:, 1])
    assert np.ptp(heading) > 0.25
    turning = np.abs(np.diff(heading)) * FRAME_RATE > 0.15
    assert np.count_nonzero(np.diff(turning.astype(int)) == 1) >= 2
    assert np.abs(heading).max() < 1.2
    assert np.abs(ahead[:, 2]).max() < 0.4

"""paintWall: strokes up and down a board, at an angle that the brush keeps and the arm does not."""

import numpy as np
import pytest
from inhand_lab.motions.paint_wall import BOARD_SIZE
from inhand_lab.objects.paint_brush import BRISTLES_BELOW
from inhand_lab.people.body_motion import BodyMotion
from inhand_schemas.joints import Joint
from inhand_tracker.geometry.arrays import Array, Flags
from performers import object_points, performed
from scipy.spatial.transform import Rotation

PARTICIPANTS = range(10)


def painting(participant: int) -> tuple[Array, Flags, Array, BodyMotion]:
    """Tips of the bristles (T, 3), whether (T,) they are on the board, rotations, and the body."""
    _, performance, body = performed("paintWall", participant)
    brush = performance.world_from_object
    board = next(box for box in performance.furniture if box.size == BOARD_SIZE)
    near = board.centre[0] - 0.5 * board.size[0]
    reached = object_points("paintWall", brush)[..., 0].max(axis=1)
    return (
        brush.apply(np.array([0.0, 0.0, -BRISTLES_BELOW])),
        near - reached < 0.004,
        (brush.rotation),
        body,
    )


def spread(rotations: Array) -> float:
    """Mean angle of rotations (T, 3, 3) from their mean, degrees."""
    every = Rotation.from_matrix(rotations)
    return float(np.degrees((every.mean().inv() * every).magnitude()).mean())


@pytest.mark.parametrize("participant", PARTICIPANTS)
def test_the_brush_goes_up_and_down_the_board(participant: int) -> None:
    tips, on_board, _, _ = painting(participant)
    assert 0.1 < on_board.mean() < 0.8
    heights = tips[on_board, 2]
    assert np.ptp(heights) > 0.2
    assert np.count_nonzero(np.diff(np.sign(heights - np.median(heights)))) >= 3


@pytest.mark.parametrize("participant", PARTICIPANTS)
def test_the_brush_is_no_extension_of_the_forearm(participant: int) -> None:
    _, on_board, rotations, body = painting(participant)
    forearm = body.joints[:, Joint.WRIST_RIGHT] - body.joints[:, Joint.ELBOW_RIGHT]
    forearm /= np.linalg.norm(forearm, axis=1, keepdims=True)
    bristles = -rotations[:, :, 2]
    angle = np.degrees(np.arccos(np.clip(np.sum(forearm * bristles, axis=1), -1.0, 1.0)))
    assert spread(rotations[on_board]) < 12.0
    assert np.ptp(angle[on_board]) > 2.0 * spread(rotations[on_board])


@pytest.mark.parametrize("participant", PARTICIPANTS)
def test_the_brush_is_dipped_into_the_pot_and_put_back_there(participant: int) -> None:
    tips, on_board, _, _ = painting(participant)
    in_pot = np.linalg.norm(tips - tips[0], axis=1) < 0.08
    assert in_pot[0]
    assert in_pot[-1]
    assert np.allclose(tips[0], tips[-1])
    assert not (in_pot & on_board).any()

"""hammerNail: strokes that end on the nail, light while the other hand holds it."""

from itertools import pairwise

import numpy as np
import pytest
from inhand_lab.motions.hammer_nail import BLOCK_SIZE, FACE, NAIL_STANDING
from inhand_lab.motions.performance import ContactKind
from inhand_schemas.joints import Joint
from inhand_tracker.geometry.arrays import Array
from performers import performed
from scipy.signal import find_peaks

everybody = pytest.mark.parametrize("participant", range(10))


def above_block(participant: int) -> Array:
    """The striking face (T, 3) from the middle of the block's top, metres."""
    _, performance, _ = performed("hammerNail", participant)
    block = performance.furniture[-1]
    top = np.array(block.centre) + np.array([0.0, 0.0, 0.5 * block.size[2]])
    return np.asarray(performance.world_from_object.apply(FACE) - top)


@everybody
def test_strokes_come_down_on_the_nail_one_after_the_other(participant: int) -> None:
    face = above_block(participant)
    hits, _ = find_peaks(-face[:, 2], prominence=0.05)
    near = hits[np.linalg.norm(face[hits, :2], axis=1) < 0.05]
    assert len(near) >= 6
    assert face[near, 2].max() < NAIL_STANDING + 0.06
    assert face[:, 2].min() > -BLOCK_SIZE[2] - 0.01


@everybody
def test_the_hammer_swings_further_once_the_nail_stands(participant: int) -> None:
    _, performance, body = performed("hammerNail", participant)
    height = above_block(participant)[:, 2]
    worked = performance.contact == ContactKind.RIGHT_HAND
    tops, _ = find_peaks(np.where(worked, height, 0.0), prominence=0.05)
    left = body.joints[:, Joint.HAND_LEFT]
    block = np.array(performance.furniture[-1].centre)
    holding = np.linalg.norm(left - block, axis=1) < 0.17
    light, hard = height[tops[holding[tops]]], height[tops[~holding[tops]]]
    assert len(light) >= 2
    assert len(hard) >= 3
    assert hard.max() > light.max() + 0.10


@everybody
def test_the_nail_sinks_with_every_stroke(participant: int) -> None:
    face = above_block(participant)
    hits, _ = find_peaks(-face[:, 2], prominence=0.05)
    depths = face[hits[np.linalg.norm(face[hits, :2], axis=1) < 0.05], 2]
    assert depths[-1] < depths[0]
    assert all(later < earlier + 0.06 for earlier, later in pairwise(depths))

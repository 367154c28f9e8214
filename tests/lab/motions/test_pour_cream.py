"""pourCream: the spout goes over the cup, and the jug is tipped more than once."""

import numpy as np
import pytest
from inhand_lab.motions.pour_cream import CUP_HEIGHT, CUP_WIDTH
from inhand_lab.objects.jug import SPOUT
from performers import performed

PARTICIPANTS = range(10)
TIPPED = 0.5
"""Radians."""


@pytest.mark.parametrize("participant", PARTICIPANTS)
def test_cream_is_poured_several_times_and_only_over_the_cup(participant: int) -> None:
    _, performance, _ = performed("pourCream", participant)
    jug = performance.world_from_object
    tipped = jug.rotation[:, 2, 2] < np.cos(TIPPED)
    assert np.count_nonzero(np.diff(tipped.astype(int)) == 1) >= 2
    cup = next(box for box in performance.furniture if box.size[2] == CUP_HEIGHT)
    offset = (jug.apply(SPOUT) - np.array(cup.centre))[tipped]
    assert np.hypot(offset[:, 0], offset[:, 1]).max() < CUP_WIDTH / 2
    assert offset[:, 2].min() > CUP_HEIGHT / 2
    assert offset[:, 2].max() < CUP_HEIGHT / 2 + 0.12


@pytest.mark.parametrize("participant", PARTICIPANTS)
def test_the_jug_is_upright_but_for_pouring(participant: int) -> None:
    _, performance, _ = performed("pourCream", participant)
    tilt = np.arccos(np.clip(performance.world_from_object.rotation[:, 2, 2], -1.0, 1.0))
    assert tilt[[0, -1]].max() < 1e-6
    assert np.median(tilt) < 0.8
    assert tilt.max() < 1.5

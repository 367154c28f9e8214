"""putOnGlasses: glasses on a head are part of it."""

import numpy as np
import pytest
from inhand_lab.motions.performance import ContactKind
from performers import FRAME_RATE, performed


@pytest.mark.parametrize("participant", range(10))
def test_worn_glasses_turn_with_the_head(participant: int) -> None:
    _, performance, body = performed("putOnGlasses", participant)
    worn = performance.contact == ContactKind.WORN
    assert worn.sum() > FRAME_RATE
    head_from_glasses = (body.from_head.inverse() @ performance.world_from_object)[worn]
    assert np.ptp(head_from_glasses.translation, axis=0).max() < 1e-9
    assert np.ptp(head_from_glasses.rotation, axis=0).max() < 1e-9

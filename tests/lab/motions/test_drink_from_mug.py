"""drinkFromMug: the rim comes to the lips and the mug is tilted there."""

import numpy as np
import pytest
from inhand_lab.motions.performance import mouth
from inhand_lab.objects.mug import MUG_HEIGHT, MUG_RADIUS
from inhand_lab.people.kinematics import place_trunk
from performers import performed


@pytest.mark.parametrize("participant", range(10))
def test_drinking_brings_the_rim_to_the_lips_and_tilts_the_mug(participant: int) -> None:
    person, performance, _ = performed("drinkFromMug", participant)
    mug = performance.world_from_object
    up = mug.rotation[:, 2, 2]
    deepest = int(np.argmin(up))
    assert up[deepest] < np.cos(0.5)
    lips = mouth(person, place_trunk(person, performance.posture))[deepest]
    local = mug[deepest].rotation.T @ (lips - mug[deepest].translation)
    assert np.hypot(local[0], local[1]) == pytest.approx(MUG_RADIUS, abs=1e-3)
    assert local[2] == pytest.approx(MUG_HEIGHT / 2, abs=1e-3)

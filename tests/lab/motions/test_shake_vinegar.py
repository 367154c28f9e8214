"""shakeVinegar: a bottle tipped over the plate and shaken in bursts."""

import numpy as np
import pytest
from inhand_lab.motions.performance import ContactKind
from inhand_lab.objects.vinegar_bottle import BOTTLE_HALF_HEIGHT
from performers import FRAME_RATE, performed
from scipy.signal import find_peaks

TOP = np.array([0.0, 0.0, BOTTLE_HALF_HEIGHT])
everybody = pytest.mark.parametrize("participant", range(10))


@everybody
def test_the_bottle_is_shaken_upside_down_in_bursts(participant: int) -> None:
    _, performance, _ = performed("shakeVinegar", participant)
    up = performance.world_from_object.rotation[:, 2, 2]
    tipped = up < -0.2
    bursts = np.count_nonzero(np.diff(tipped.astype(int)) == 1)
    assert bursts >= 2
    top = performance.world_from_object.apply(TOP)[:, 2]
    shakes, _ = find_peaks(top, prominence=0.006)
    assert np.count_nonzero(tipped[shakes]) >= 2 * bursts


@everybody
def test_it_is_shaken_over_the_plate(participant: int) -> None:
    _, performance, _ = performed("shakeVinegar", participant)
    tipped = performance.world_from_object.rotation[:, 2, 2] < -0.4
    top = performance.world_from_object.apply(TOP)[tipped]
    plate = np.array(performance.furniture[-1].centre)
    assert tipped.sum() > FRAME_RATE
    assert np.linalg.norm((top - plate)[:, :2], axis=1).max() < 0.15
    assert (top - plate)[:, 2].min() > 0.02
    assert (top - plate)[:, 2].max() < 0.30


@everybody
def test_only_the_right_hand_carries_it(participant: int) -> None:
    _, performance, _ = performed("shakeVinegar", participant)
    assert set(performance.contact) == {ContactKind.RESTING, ContactKind.RIGHT_HAND}

"""Recordings in a light of another colour."""

from dataclasses import replace

import numpy as np
from inhand_lab.datasets.observations import Observation
from inhand_lab.datasets.other_light import RECORDED, in_light
from rooms import room

SEEN = Observation(7, None, room(), somebody_else=False)


def test_the_colours_alone_change_and_are_bounded() -> None:
    (lit,) = in_light([SEEN], (0.5, 1.0, 4.0))
    assert lit.image is not None
    assert lit.image.colour is not None
    assert SEEN.image is not None
    assert SEEN.image.colour is not None
    expected = np.minimum(np.rint(SEEN.image.colour * np.array([0.5, 1.0, 4.0])), 255.0)
    np.testing.assert_array_equal(lit.image.colour, expected)
    assert lit.image.depth is SEEN.image.depth
    assert replace(lit, image=SEEN.image) == SEEN


def test_what_was_recorded_stays_as_it_is() -> None:
    dark = replace(SEEN, image=replace(room(), colour=None))
    nothing = replace(SEEN, image=None)
    assert list(in_light([SEEN], RECORDED)) == [SEEN]
    assert list(in_light([dark, nothing], (0.5, 1.0, 1.0))) == [dark, nothing]

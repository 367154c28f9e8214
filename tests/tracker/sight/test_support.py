"""What an image says for an object that a tracker looks for, whichever thing is in it."""

from dataclasses import replace

import numpy as np
import pytest
from inhand_tracker.geometry.bounding_sphere import BoundingSphere
from inhand_tracker.geometry.image import Image
from inhand_tracker.geometry.pose_gaussian import PoseGaussian, PoseMixture
from inhand_tracker.methods.fusion.parameters import DEFAULT_FUSION
from inhand_tracker.methods.fusion.search import ImageSearch
from inhand_tracker.sight.appearance import Appearance
from inhand_tracker.sight.support import Support
from sights import EXTENTS, PLACE, TURN, appearance, draw, sight

SPREAD = np.diag([0.02, 0.02, 0.02, 0.1, 0.1, 0.1]) ** 2
FAR_AWAY = np.full((20, 3), 30.0)


def green() -> Image:
    """The same box in another colour, before the same wall."""
    image = draw()
    red = image.colour[..., 0] > image.colour[..., 1] + 20
    return replace(
        image, colour=np.where(red[..., None], image.colour[..., [1, 0, 2]], image.colour)
    )


def looked_at(image: Image, learned: Appearance | None, looks: int = 20) -> Support:
    """The last support of a box that is looked for where the one in the image is."""
    sphere = BoundingSphere(np.zeros(3), float(np.linalg.norm(EXTENTS)) / 2)
    search = ImageSearch(sight(learned=learned), sphere, DEFAULT_FUSION, seed=3)
    belief = PoseMixture((PoseGaussian(PLACE, TURN, SPREAD),), np.ones(1))
    for _ in range(looks):
        search.look(belief, image, FAR_AWAY, 1.0)
    assert search.support is not None
    return search.support


def test_the_object_itself_is_supported_by_all_its_parts_and_in_its_own_colours() -> None:
    support = looked_at(draw(), appearance())
    assert min(support.parts) > 0.0
    assert abs(support.recoloured) < 0.3


def test_a_like_thing_of_another_colour_is_recoloured_and_supported_less() -> None:
    own, other = looked_at(draw(), appearance()), looked_at(green(), appearance())
    assert other.recoloured > 1.0
    assert other.interior < own.interior - 1.0
    assert other.depth == pytest.approx(own.depth, rel=0.2)


def test_colours_that_were_never_trained_are_not_learned_anew() -> None:
    assert looked_at(draw(), None).recoloured == 0.0

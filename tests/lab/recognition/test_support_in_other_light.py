"""What images say for an object whose colours were learned in another light."""

import math
from dataclasses import replace

import numpy as np
import pytest
from drinkers import FRAME_NS, drinking, image, mug_model, skeletons
from inhand_tracker.methods.fusion.tracker import FusionTracker
from inhand_tracker.model.model import Model
from inhand_tracker.sight.light import scale_colours
from rooms import USUAL

pytestmark = [pytest.mark.long, pytest.mark.timeout(600)]

STRANGER = 4
FRAMES = range(30, 60)


def supports(model: Model, light: tuple[float, float, float]) -> np.ndarray:
    """The images' support (T,) for the mug in a stranger's hand."""
    simulation = drinking(STRANGER)
    tracker = FusionTracker(model, left_handed=simulation.person.handedness == "left")
    supported = []
    for frame in FRAMES:
        seen = image(STRANGER, frame)
        assert seen.colour is not None
        lit = replace(seen, colour=scale_colours(seen.colour, np.array(light)))
        tracker.step(skeletons(simulation)[frame], (frame + 1) * FRAME_NS, lit)
        assert tracker.support is not None
        supported.append(tracker.support.log_likelihood)
    return np.array(supported)


def without_light(model: Model) -> Model:
    """The model as of a release that learned no light."""
    assert model.appearance is not None
    unknown = replace(model.appearance, tint=math.nan, tint_range=math.nan)
    return replace(model, appearance=unknown)


@pytest.mark.parametrize("light", [(0.75, 1.0, 1.25), (1.25, 1.0, 0.75)])
def test_an_object_is_supported_in_another_light_nearly_as_in_that_of_training(
    light: tuple[float, float, float],
) -> None:
    model = mug_model()
    usual = supports(model, USUAL).mean()
    lost = usual - supports(model, light).mean()
    lost_without = usual - supports(without_light(model), light).mean()
    assert lost_without > 0.8
    assert lost < 0.4 * lost_without


def test_in_the_light_of_training_nothing_changes() -> None:
    model = mug_model()
    np.testing.assert_array_equal(supports(model, USUAL), supports(without_light(model), USUAL))

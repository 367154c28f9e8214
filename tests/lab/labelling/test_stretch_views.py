"""Images of a stretch, read when they are looked at."""

from pathlib import Path

import numpy as np
import pytest
from changed_recordings import replace, write_messages
from inhand_lab.datasets.frame_index import open_frames
from inhand_lab.labelling.interpolation import Stretch
from inhand_lab.labelling.scene import load_scene
from inhand_lab.labelling.stretch_views import Backwards, StretchViews, image_at
from inhand_schemas.messages import Message, RgbdFrame
from sights import sight
from waving import messages

STRETCH = Stretch(2, 8)


def recorded() -> list[Message]:
    """A recording in which the third frame's image is damaged, and the fourth one's lacking."""
    shown = list(messages(12, 0, images=True))
    images = [index for index, one in enumerate(shown) if isinstance(one, RgbdFrame)]
    broken = shown[images[3]]
    assert isinstance(broken, RgbdFrame)
    colour = replace(broken.colour, data=broken.colour.data[:100])  # type: ignore[type-var, union-attr]
    shown[images[3]] = replace(broken, colour=colour)
    del shown[images[4]]
    return shown


def test_the_last_views_stay_and_earlier_ones_are_made_again(tmp_path: Path) -> None:
    path = write_messages(tmp_path / "wave.mcap", recorded())
    scene = load_scene(path, "camera")
    with open_frames(path) as frames:
        views = StretchViews(scene, frames, sight(), STRETCH, kept=2)
        assert len(views) == 7
        last = views[6]
        assert views[5] is views[5]
        assert views[6] is last
        assert views[0] is not None
        assert views[3] is not None
        assert views[6] is not last
        with pytest.raises(IndexError):
            views[7]


def test_a_damaged_image_and_a_missing_one_show_nothing(tmp_path: Path) -> None:
    path = write_messages(tmp_path / "wave.mcap", recorded())
    scene = load_scene(path, "camera")
    with open_frames(path) as frames:
        views = StretchViews(scene, frames, sight(), STRETCH, kept=9)
        assert [view is None for view in views] == [False, True, True, *[False] * 4]
        image = image_at(scene, frames, 5)
        assert image is not None
        assert views[3] is not None
        np.testing.assert_array_equal(views[3].frame.colour, image.colour)


def test_backwards_is_the_same_from_the_end() -> None:
    back = Backwards("abc")
    assert list(back) == ["c", "b", "a"]
    assert back[0:2] == ["c", "b"]
    assert back[-1] == "a"

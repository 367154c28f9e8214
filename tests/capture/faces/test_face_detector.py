"""What is found in the mirror image beside a picture is in the picture."""

import numpy as np
import pytest
from inhand_capture.estimation.regions import Region, crop
from inhand_capture.faces.face_detector import SIDE, _mirrored_into


@pytest.mark.parametrize("place", [-30.0, -0.25, 0.0, 12.5, 99.0, 99.5, 130.0])
def test_a_place_beside_a_picture_is_where_its_mirror_image_shows(place: float) -> None:
    ramp = np.tile(np.arange(100, dtype=np.uint8), (100, 1))
    picture = np.repeat(ramp[..., None], 3, axis=2)
    # A pixel of the crop is one of the picture.
    view = Region(place + 0.5, 50.0, float(SIDE))
    shown = crop(picture, view, SIDE, beside="mirror")[SIDE // 2, SIDE // 2, 0]
    assert shown == pytest.approx(_mirrored_into(place, 100), abs=1.0)


def test_what_is_far_beside_a_picture_is_at_its_edge() -> None:
    assert _mirrored_into(-1e6, 100) == 99.0
    assert _mirrored_into(1e6, 100) == 0.0

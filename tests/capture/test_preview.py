"""Small pictures at a low rate, for people who look."""

from dataclasses import dataclass, field

import numpy as np
import pytest
import simplejpeg
from inhand_capture.parameters import DEFAULT_PREVIEW
from inhand_capture.preview import Previews, preview_of
from inhand_runtime.health import HealthBoard
from inhand_runtime.source import Captured, Pixels
from inhand_schemas.messages import ColourImage, Preview
from inhand_schemas.topics import PREVIEW
from numpy.typing import NDArray
from running_rig import RunningRig, eventually
from wire import Wire

SECOND_NS = 1_000_000_000
FRAME_NS = SECOND_NS // 30


@dataclass
class Listener:
    """An outlet to somebody who listens, or not."""

    listens: bool = True
    heard: list[Preview] = field(default_factory=list)

    def put(self, message: Preview) -> None:
        self.heard.append(message)

    def wanted(self) -> bool:
        return self.listens


def _captured(time_ns: int, colour: NDArray[np.uint8] | ColourImage | None) -> Captured:
    return Captured(time_ns, 0, lambda: Pixels(colour, None), None)


def _forbidden() -> Pixels:
    pytest.fail("got although nobody listens, or no preview is due")


@pytest.mark.parametrize(
    ("width", "height", "size"),
    [(640, 480, (320, 240)), (1280, 720, (320, 180)), (480, 640, (240, 320)), (64, 48, (64, 48)),
     (2000, 3, (320, 1))],
)  # fmt: skip
def test_a_preview_is_small_and_looks_like_its_frame(
    width: int, height: int, size: tuple[int, int]
) -> None:
    colour = np.zeros((height, width, 3), np.uint8)
    colour[:, : width // 2] = (200, 40, 40)
    preview = preview_of(colour, 7, 99)
    assert (preview.width, preview.height) == size
    assert (preview.sequence, preview.time_ns) == (7, 99)
    picture = simplejpeg.decode_jpeg(preview.jpeg, "RGB")
    assert picture.shape == (preview.height, preview.width, 3)
    assert picture[:, 5].mean(axis=0) == pytest.approx((200, 40, 40), abs=12)
    assert picture[:, -5].max() < 30
    assert PREVIEW.decode(PREVIEW.encode(preview)) == preview


def test_few_frames_have_a_preview_and_it_has_its_frame_s_number_and_time() -> None:
    listener = Listener()
    previews = Previews(listener, HealthBoard("capture", "front"))
    colour = np.full((48, 64, 3), 100, np.uint8)
    for number in range(61):
        previews.publish(_captured(number * FRAME_NS, colour), number)
    assert 8 <= len(listener.heard) <= 11
    for one in listener.heard:
        assert one.time_ns == one.sequence * FRAME_NS
    times = np.array([one.time_ns for one in listener.heard])
    assert np.diff(times).min() >= 1e9 * DEFAULT_PREVIEW.period_s


def test_nothing_is_computed_that_nobody_listens_to_or_that_is_not_due() -> None:
    listener = Listener(listens=False)
    previews = Previews(listener, HealthBoard("capture", "front"))
    previews.publish(Captured(0, 0, _forbidden, None), 0)
    listener.listens = True
    previews.publish(_captured(FRAME_NS, np.zeros((48, 64, 3), np.uint8)), 1)
    previews.publish(Captured(2 * FRAME_NS, 0, _forbidden, None), 2)
    assert [one.sequence for one in listener.heard] == [1]


def test_a_clock_that_is_set_back_does_not_stop_previews() -> None:
    listener = Listener()
    previews = Previews(listener, HealthBoard("capture", "front"))
    for time_ns in (10**18, 5):
        previews.publish(_captured(time_ns, np.zeros((48, 64, 3), np.uint8)), 0)
    assert [one.time_ns for one in listener.heard] == [10**18, 5]


def test_a_damaged_picture_is_a_trouble_until_one_is_whole() -> None:
    listener, health = Listener(), HealthBoard("capture", "front")
    health.state = "running"
    previews = Previews(listener, health)
    previews.publish(_captured(0, ColourImage("jpeg", 64, 48, b"no")), 0)
    (trouble,) = health.report().troubles
    assert trouble.startswith("there is no preview of a picture: damaged JPEG")
    previews.publish(_captured(SECOND_NS, np.zeros((48, 64, 3), np.uint8)), 1)
    assert health.report().troubles == ()


def test_a_camera_without_colour_has_no_preview() -> None:
    listener = Listener()
    Previews(listener, HealthBoard("capture", "front")).publish(_captured(0, None), 0)
    assert listener.heard == []


@pytest.mark.long
def test_a_daemon_makes_previews_for_who_listens_to_nothing_else_until_its_shutter_closes(
    wire: Wire, rig: RunningRig, own_data: object
) -> None:
    heard = wire.hear(PREVIEW)
    rig.configure(
        '[capture.front]\nsource = "simulator"\nmasks = [[[0, 0], [0.5, 0], [0.5, 1], [0, 1]]]\n'
    )
    daemon = rig.python("-m", "inhand_capture", "--config", rig.config)
    eventually("previews", lambda: len(heard) >= 5)
    for one in heard:
        picture = simplejpeg.decode_jpeg(PREVIEW.decode(one.payload).jpeg, "RGB")
        assert picture[:, :150].max() < 70
        assert picture[:, 170:].max() > 100
    closed = rig.done("shutter", "close", "--config", rig.config)
    assert closed.popen.returncode == 0, closed.stderr
    count = len(heard)
    rig.health("front")
    assert len(heard) == count
    assert rig.counted("front", "inhand/@v1/rig/rgbd/front", "published") == 0
    assert daemon.stop() == 0

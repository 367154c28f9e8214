"""When the floor is looked for."""

from inhand_outcomes.floor_watch import DEFAULT_FLOOR_WATCH, FloorWatch
from inhand_outcomes.gathering import NS_PER_S
from inhand_schemas.messages import CameraInfo, RgbdFrame

START_NS = 1_000 * NS_PER_S
INFO = CameraInfo(
    sequence=0, time_ns=START_NS, width=640, height=480, fx=500.0, fy=500.0, cx=320.0, cy=240.0
)


def no_look(*_: object) -> None:
    raise AssertionError("there is nothing to see")


def test_frames_without_depth_are_asked_for_no_more_often_than_others() -> None:
    floors = FloorWatch(no_look)
    floors.hear_info("front", INFO)
    assert floors.wants_frame(START_NS)
    floors.hear_frame("front", RgbdFrame(sequence=1, time_ns=START_NS))
    period_ns = round(DEFAULT_FLOOR_WATCH.first_period_s * NS_PER_S)
    assert not floors.wants_frame(START_NS + period_ns // 2)
    assert floors.wants_frame(START_NS + period_ns)
    assert floors.room is None


def test_a_frame_of_a_camera_that_is_not_known_is_no_look() -> None:
    floors = FloorWatch(no_look)
    floors.hear_frame("front", RgbdFrame(sequence=1, time_ns=START_NS))
    assert floors.wants_frame(START_NS)

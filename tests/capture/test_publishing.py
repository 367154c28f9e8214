"""Which messages a moment becomes."""

from dataclasses import dataclass, field, replace
from functools import partial

import numpy as np
import pytest
from inhand_capture.publishing import CameraPublisher, encoded_depth
from inhand_runtime.pixels import decode_depth, encode_depth
from inhand_runtime.source import Captured, Pixels
from inhand_schemas.messages import CameraInfo, ColourImage, DepthImage, Message, RgbdFrame
from inhand_schemas.topics import AnyTopic
from msgspec import structs
from scripted_source import FIRST_NS, PERSON, moment

INFO = CameraInfo(sequence=9, time_ns=0, width=64, height=48, fx=50, fy=50, cx=32, cy=24)


@dataclass
class FakeOutlets:
    """Remembers what was put, as (stream/name, message)."""

    wanted_streams: set[str]
    sent: list[tuple[str, Message]] = field(default_factory=list)

    def publisher(self, topic: AnyTopic, name: str) -> "FakeOutlet":
        """An outlet that is wanted when its stream is."""
        return FakeOutlet(self, topic.stream, name)


@dataclass
class FakeOutlet:
    """One stream and name."""

    outlets: FakeOutlets
    stream: str
    name: str

    def put(self, message: Message) -> None:
        """Remember."""
        self.outlets.sent.append((f"{self.stream}/{self.name}", message))

    def wanted(self) -> bool:
        """As the test says."""
        return self.stream in self.outlets.wanted_streams


def _forbidden() -> Pixels:
    pytest.fail("rendered although nobody listens")


def test_a_moment_becomes_skeletons_labels_and_then_pictures_of_one_sequence_and_time() -> None:
    outlets = FakeOutlets({"skeletons", "rgbd", "label"})
    camera = CameraPublisher(outlets, "front")
    camera.publish(moment(0))
    camera.publish(moment(1))
    assert [key for key, _ in outlets.sent] == 2 * ["skeletons/front", "label/mug", "rgbd/front"]
    assert [message.sequence for _, message in outlets.sent] == [0, 0, 0, 1, 1, 1]
    assert {message.time_ns for _, message in outlets.sent[:3]} == {FIRST_NS}
    assert outlets.sent[0][1].people == (PERSON,)
    assert outlets.sent[0][1].convention == "kinect_v2"
    assert outlets.sent[1][1].camera == "front"


def test_nothing_is_encoded_or_sent_that_nobody_wants() -> None:
    outlets = FakeOutlets({"skeletons"})
    camera = CameraPublisher(outlets, "front")
    camera.publish(replace(moment(0), pixels=_forbidden))
    assert [key for key, _ in outlets.sent] == ["skeletons/front"]
    outlets.wanted_streams.clear()
    camera.publish(replace(moment(1), pixels=_forbidden))
    assert len(outlets.sent) == 1
    outlets.wanted_streams.add("rgbd")
    camera.publish(moment(2))
    assert outlets.sent[-1][1].sequence == 2


def test_a_source_without_skeletons_or_pictures_publishes_what_it_has() -> None:
    outlets = FakeOutlets({"skeletons", "rgbd", "label"})
    camera = CameraPublisher(outlets, "front")
    camera.publish(Captured(1, 0, pixels=None, people=None))
    assert outlets.sent == []
    camera.publish(Captured(2, 0, pixels=None, people=()))
    assert [key for key, _ in outlets.sent] == ["skeletons/front"]


def test_raw_pixels_are_encoded() -> None:
    outlets = FakeOutlets({"rgbd"})
    CameraPublisher(outlets, "front").publish(moment(5))
    frame = outlets.sent[0][1]
    assert isinstance(frame, RgbdFrame)
    assert frame.time_uncertainty_ns == 1000
    assert frame.colour is not None
    assert frame.colour.codec == "jpeg"
    assert frame.depth is not None
    assert np.all(decode_depth(frame.depth) == 5)


def test_encoded_pixels_pass_untouched() -> None:
    outlets = FakeOutlets({"rgbd"})
    pixels = Pixels(ColourImage("jpeg", 2, 1, b"any"), DepthImage("z16-zstd", 2, 1, b"bytes"))
    CameraPublisher(outlets, "front").publish(Captured(1, 0, lambda: pixels, None))
    frame = outlets.sent[0][1]
    assert isinstance(frame, RgbdFrame)
    assert Pixels(frame.colour, frame.depth) == pixels


def test_every_introduction_is_sent_with_a_sequence_of_its_own() -> None:
    outlets = FakeOutlets(set())
    camera = CameraPublisher(outlets, "front")
    camera.introduce(INFO)
    camera.introduce(structs.replace(INFO, time_ns=77))
    assert [message.sequence for _, message in outlets.sent] == [0, 1]
    assert outlets.sent[0][1].time_ns > FIRST_NS
    assert outlets.sent[1][1].time_ns == 77


def test_depth_is_png_where_a_setting_asks_for_it_also_of_what_is_encoded_already() -> None:
    depth = np.arange(64 * 48, dtype=np.uint16).reshape(48, 64)
    for given in (depth, encode_depth(depth), encode_depth(depth, "png16")):
        outlets = FakeOutlets({"rgbd"})
        camera = CameraPublisher(outlets, "front", "png16")
        camera.publish(Captured(1, 0, partial(Pixels, None, given), None))
        frame = outlets.sent[0][1]
        assert isinstance(frame, RgbdFrame)
        assert frame.depth is not None
        assert frame.depth.codec == "png16"
        np.testing.assert_array_equal(decode_depth(frame.depth), depth)


def test_damaged_depth_passes_as_it_is_for_its_readers_to_refuse() -> None:
    damaged = DepthImage("z16-zstd", 64, 48, b"no depth")
    assert encoded_depth(damaged, "png16") is damaged

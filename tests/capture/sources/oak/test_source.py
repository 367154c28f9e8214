"""The driver on depthai itself, with a stub for the sensor nodes alone."""

import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace

import inhand_capture.sources.oak.source as source_module
import numpy as np
import pytest
from inhand_capture.sources.oak.parameters import OAK
from inhand_capture.sources.oak.source import OakSource
from inhand_runtime.pixels import decode_colour
from inhand_runtime.source import Captured, SourceError, SourceLostError
from inhand_schemas.messages import ColourImage
from running_rig import eventually
from stub_oak import FOCAL, Exposure, Shots, StubCamera


@pytest.fixture
def _impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    quick = replace(OAK, silence_s=1.0, first_pair_s=1.5)
    monkeypatch.setattr(source_module, "OAK", quick)


def _moments(source: OakSource) -> Iterator[Captured]:
    return (captured for captured in source.captures(lambda: True) if captured is not None)


@pytest.fixture
def open_(request: pytest.FixtureRequest) -> Callable[..., OakSource]:
    """Opens sources that are closed after the test."""

    def opened(camera: StubCamera, **options: object) -> OakSource:
        source = OakSource({"mjpeg": camera.mjpeg, **options}, camera.connect)
        request.addfinalizer(source.close)
        return source

    return opened


Open = Callable[..., OakSource]


def _number(captured: Captured) -> tuple[int, int]:
    """Return the numbers that colour and depth show."""
    assert captured.pixels is not None
    pixels = captured.pixels()
    assert isinstance(pixels.colour, np.ndarray)
    assert isinstance(pixels.depth, np.ndarray)
    return int(pixels.colour[0, 0, 0]), int(pixels.depth[0, 0]) - 1000


def test_each_moment_holds_colour_and_depth_of_one_exposure_and_its_true_time(open_: Open) -> None:
    camera = StubCamera()
    source = open_(camera)
    moments = _moments(source)
    for number in range(1, 20):
        camera.send(number)
        captured = next(moments)
        assert _number(captured) == (number, number)
        assert camera.sensors is not None
        true_ns = camera.sensors.sent[number] + time.time_ns() - time.monotonic_ns()
        assert abs(captured.time_ns - true_ns) <= captured.time_uncertainty_ns < 10_000_000


def test_intrinsics_are_those_of_the_published_picture(open_: Open) -> None:
    source = open_(StubCamera(shots=Shots(3, 1280, 720)), size="1280x720")
    info = source.info
    assert (info.width, info.height, info.fx, info.cx, info.cy) == (1280, 720, FOCAL, 640, 360)
    assert info.description == "a stub of a camera"


def test_the_devices_jpeg_passes_untouched(open_: Open) -> None:
    camera = StubCamera(mjpeg=True)
    source = open_(camera)
    moments = _moments(source)
    camera.send(77)
    pixels = next(moments).pixels
    assert pixels is not None
    colour = pixels().colour
    assert isinstance(colour, ColourImage)
    assert (colour.codec, colour.width, colour.height) == ("jpeg", 640, 480)
    assert abs(int(decode_colour(colour)[0, 0, 0]) - 77) <= 2


@pytest.mark.long
def test_streams_that_number_differently_are_paired_by_their_times(open_: Open) -> None:
    first = [Exposure(n, depth_number=n + 5, depth_later_s=0.012) for n in range(12)]
    camera = StubCamera(first=first, period_s=0.034)
    source = open_(camera)
    moments = _moments(source)
    shown = []
    while 11 not in shown:
        colour, depth = _number(next(moments))
        assert colour == depth
        shown.append(colour)


def test_colour_without_its_depth_is_left_out(open_: Open) -> None:
    camera = StubCamera()
    source = open_(camera)
    moments = _moments(source)
    camera.send(1, depth=False)
    camera.send(2, colour=False)
    camera.send(3)
    assert _number(next(moments)) == (3, 3)


def test_a_slow_reader_gets_the_newest_moment(open_: Open) -> None:
    camera = StubCamera()
    source = open_(camera)
    moments = _moments(source)
    camera.send(1)
    next(moments)
    camera.send(*range(2, 60))
    sensors = camera.sensors
    assert sensors is not None
    eventually("all exposures", lambda: 59 in sensors.sent and sensors.commands.empty())
    time.sleep(0.1)
    assert _number(next(moments)) == (59, 59)


def test_a_reader_that_misses_many_frames_is_told(
    monkeypatch: pytest.MonkeyPatch, open_: Open
) -> None:
    monkeypatch.setattr(source_module, "OAK", replace(source_module.OAK, condition_s=0.0))
    camera = StubCamera()
    source = open_(camera)
    moments = _moments(source)
    for number in range(1, 10):
        camera.send(number)
        next(moments)
    assert source.troubles() == {}
    for number in range(20, 100, 10):
        camera.send(number)
        next(moments)
    assert "only 8 of the camera's last 81 frames" in source.troubles()["pace"]


def test_a_device_that_cannot_be_closed_in_order_is_closed_all_the_same(open_: Open) -> None:
    camera = StubCamera(fails_to_close=True)
    source = open_(camera)
    source.close()
    assert camera.closed == 1


def test_a_break_in_mid_stream_is_a_loss_with_its_reason(open_: Open) -> None:
    camera = StubCamera(died="the camera's firmware crashed")
    source = open_(camera)
    moments = _moments(source)
    camera.send(1)
    next(moments)
    camera.break_link()
    with pytest.raises(SourceLostError, match="firmware crashed; it is opened again"):
        next(moments)
    source.close()
    assert camera.closed == 1


@pytest.mark.long
@pytest.mark.usefixtures("_impatient")
@pytest.mark.parametrize(
    ("alive", "line"),
    [
        ({"colour": False, "depth": False}, "no colour and no depth came for"),
        ({"colour": True, "depth": False}, "no depth came for"),
        ({"colour": False, "depth": True}, "no colour came for"),
        ({"colour": True, "depth": True, "depth_later_s": 0.4}, "never belong together"),
    ],
)
def test_silence_is_a_loss_though_nothing_was_raised(
    open_: Open, alive: dict[str, object], line: str
) -> None:
    camera = StubCamera()
    source = open_(camera)
    moments = _moments(source)
    stop = threading.Event()

    def go_on() -> None:
        number = 1
        while not stop.wait(0.03):
            camera.send(number, **alive)
            number += 1

    sending = threading.Thread(target=go_on)
    sending.start()
    with pytest.raises(SourceLostError, match=line):
        next(moments)
    stop.set()
    sending.join()


@pytest.mark.long
@pytest.mark.usefixtures("_impatient")
def test_a_reader_that_took_long_is_not_the_cameras_silence(open_: Open) -> None:
    camera = StubCamera()
    source = open_(camera)
    moments = _moments(source)
    camera.send(1)
    next(moments)
    time.sleep(1.2)
    camera.send(2)
    assert _number(next(moments)) == (2, 2)


@pytest.mark.long
@pytest.mark.usefixtures("_impatient")
def test_a_camera_that_sends_nothing_at_first_is_closed_again(open_: Open) -> None:
    camera = StubCamera(first=())
    with pytest.raises(SourceLostError, match="no colour and no depth"):
        open_(camera)
    assert camera.closed == 1


@pytest.mark.parametrize(
    ("camera", "line"),
    [
        (StubCamera(focal=1.0), "the camera knows no intrinsics"),
        (StubCamera(focal=-FOCAL), "the camera knows no intrinsics"),
        (
            StubCamera(shots=Shots(1, 1280, 800)),
            "sends colour of 1280 × 800 where 640 × 480 was asked for",
        ),
    ],
)
def test_frames_that_cannot_be_used_are_refused(open_: Open, camera: StubCamera, line: str) -> None:
    with pytest.raises(SourceError, match=line):
        open_(camera)
    assert camera.closed == 1


def test_closing_ends_a_wait_from_another_thread_and_may_be_repeated(open_: Open) -> None:
    camera = StubCamera()
    source = open_(camera)
    closing = threading.Timer(0.1, source.close)
    closing.start()
    assert list(_moments(source)) == []
    closing.join()
    source.close()
    assert camera.closed == 1


def test_a_device_says_what_is_wrong_with_it_though_frames_come(open_: Open) -> None:
    camera = StubCamera(troubles={"heat": "it is hot"})
    source = open_(camera)
    assert source.troubles() == {"heat": "it is hot"}


def test_exposure_and_light_can_be_changed_while_it_runs(open_: Open) -> None:
    camera = StubCamera()
    source = open_(camera, focus=100)
    source.control({"exposure_us": 8000, "iso": 400})
    source.control({"focus": None, "ir_dots": 0.5})
    (first, made_automatic), (second, automatic) = camera.controls
    assert (made_automatic, automatic) == ([], ["focus"])
    assert (first.exposure_us, first.iso, first.focus, first.ir_dots) == (8000, 400, 100, 0.0)
    assert (second.exposure_us, second.iso, second.focus, second.ir_dots) == (8000, 400, None, 0.5)


@pytest.mark.parametrize(
    ("options", "line"),
    [
        ({"size": 1}, "size cannot be changed while it runs; what can: exposure_us, iso"),
        ({"exposure_us": 8000}, "exposure_us and iso are set together"),
        ({"focus": 256}, "options.focus"),
    ],
)
def test_what_cannot_be_changed_so_is_told(
    open_: Open, options: dict[str, object], line: str
) -> None:
    camera = StubCamera()
    source = open_(camera)
    with pytest.raises(SourceError, match=line):
        source.control(options)
    assert camera.controls == []


@pytest.mark.parametrize(
    ("options", "line"),
    [
        ({"serial": "1", "ip": "10.0.0.1"}, "serial and ip both say which camera"),
        ({"exposure_us": 5000}, "exposure_us and iso are set together"),
        ({"ip": "camera.local"}, "is no IP address"),
        ({"usb_port": "left"}, "is no USB port"),
        ({"size": "800x600"}, "options.size"),
        ({"serail": "1"}, r"did you mean serial\?"),
    ],
)
def test_wrong_options_are_told(options: dict[str, object], line: str) -> None:
    with pytest.raises(SourceError, match=line):
        OakSource(options)

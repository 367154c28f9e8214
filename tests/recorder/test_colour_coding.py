"""Colour is recorded as H.264 where that can be done, and as it came where not; nothing is lost."""

import io
import time
from collections.abc import Callable
from pathlib import Path

import av
import numpy as np
import pytest
import simplejpeg
from coded_rig import KEY, CodedRig, Heard, entry, frame, picture, record
from inhand_recorder import colour_coding
from inhand_recorder.colour_coding import COLOUR_RECORD, MOST_CODERS, MOST_WAITING, ColourCoding
from inhand_recorder.colour_encoder import ColourEncoder
from inhand_recorder.recording_file import Entry
from inhand_recorder.verification import verify_recording
from inhand_runtime.pixels import decode_colour, decode_depth, encode_colour
from inhand_runtime.recording import RecordedMessage, read_metadata, read_recording
from inhand_runtime.recording.coded_colour import LONGEST_CHAIN
from inhand_schemas.keys import Site
from inhand_schemas.messages import ColourImage, RgbdFrame
from inhand_schemas.topics import RGBD
from small_rig import FRAME_NS, START_NS, depth_of


def frames_of(path: Path) -> list[RecordedMessage]:
    return list(read_recording(path, streams=("rgbd",)))


def image_of(message: RecordedMessage) -> ColourImage:
    """The colour as it stands in the file."""
    colour = RGBD.decode(message.payload).colour
    assert colour is not None
    return colour


def codecs(path: Path) -> list[str]:
    return [image_of(one).codec for one in frames_of(path)]


def errors_db(path: Path) -> list[float]:
    """The peak signal-to-noise ratio of each decoded picture to the one that was recorded."""
    ratios = []
    for one in frames_of(path):
        decoded = decode_colour(one.frame().colour).astype(float)
        square = np.mean((decoded - decode_colour(frame(one.sequence).colour)) ** 2)
        ratios.append(10.0 * np.log10(255.0**2 / max(square, 1e-9)))
    return ratios


def test_pictures_come_back_and_depth_without_loss(tmp_path: Path) -> None:
    path = record(tmp_path, 40)
    assert codecs(path) == ["h264"] * 40
    assert verify_recording(path) == []
    assert min(errors_db(path)) > 33.0
    for one in frames_of(path):
        np.testing.assert_array_equal(decode_depth(one.frame().depth), depth_of(one.sequence))
    assert read_metadata(path)[COLOUR_RECORD][KEY] == "coded=40"


def test_another_reader_decodes_the_same_pictures(tmp_path: Path) -> None:
    recorded = frames_of(record(tmp_path, 40))
    stream = io.BytesIO(b"".join(image_of(one).data for one in recorded))
    with av.open(stream, format="h264") as container:
        (video,) = container.streams.video
        assert (video.codec_context.has_b_frames, video.width, video.height) == (False, 64, 48)
        theirs = [one.to_ndarray(format="rgb24") for one in container.decode(video)]
    assert len(theirs) == 40
    for one, other in zip(recorded, theirs, strict=True):
        np.testing.assert_array_equal(decode_colour(one.frame().colour), other)


def test_a_picture_begins_anew_each_second_however_few_come(tmp_path: Path) -> None:
    rig = CodedRig(tmp_path)
    encoder = ColourEncoder()
    rig.record(frame(number) for number in range(65))
    begins = [n for n, one in enumerate(frames_of(rig.split())) if image_of(one).builds_on is None]
    assert begins == [0, 31, 62]
    slow = [encoder.encode(frame(n).colour, n * 10**9) for n in range(3)]
    assert [one.builds_on for one in slow] == [None] * 3
    fast = [encoder.encode(frame(n).colour, 3 * 10**9 + n) for n in range(LONGEST_CHAIN + 1)]
    assert [n for n, one in enumerate(fast) if one.builds_on is None] == [0, LONGEST_CHAIN]


def test_each_file_stands_alone(tmp_path: Path) -> None:
    rig = CodedRig(tmp_path)
    rig.record(frame(number) for number in range(10))
    first = rig.split()
    rig.record(frame(number) for number in range(10, 20))
    second = rig.split()
    assert codecs(second) == ["jpeg"] + 9 * ["h264"]
    assert image_of(frames_of(second)[1]).builds_on is None
    for path in (first, second):
        assert verify_recording(path) == []
        assert min(errors_db(path)) > 33.0
    assert rig.coding.counts == {"coded": 19, "baseless": 1}
    assert rig.heard.texts == []


def grey(number: int) -> ColourImage:
    one = picture(number)[..., :1].copy()
    return ColourImage("jpeg", 64, 48, simplejpeg.encode_jpeg(one, 90, "GRAY"))


def damaged(number: int) -> ColourImage:
    whole = encode_colour(picture(number))
    return ColourImage("jpeg", 64, 48, whole.data[: len(whole.data) // 2])


def raw(number: int) -> ColourImage:
    return ColourImage("rgb8", 64, 48, picture(number).tobytes())


def odd(number: int) -> ColourImage:
    return encode_colour(picture(number)[:47, :63])


def larger(number: int) -> ColourImage:
    return encode_colour(picture(number, 96, 64))


@pytest.mark.parametrize(
    ("other", "codec", "why"),
    [
        (grey, "h264", None),
        (raw, "h264", None),
        (larger, "h264", None),
        (damaged, "jpeg", "damaged JPEG"),
        (odd, "jpeg", "H.264 holds no image of 63 × 47"),
    ],
)
def test_a_picture_of_another_kind_is_coded_or_kept_as_it_came_and_said(
    tmp_path: Path, other: Callable[[int], ColourImage], codec: str, why: str | None
) -> None:
    rig = CodedRig(tmp_path)
    frames = [frame(number) for number in range(9)]
    frames[3] = frame(3, other(3))
    rig.record(frames)
    path = rig.split()
    assert codecs(path) == 3 * ["h264"] + [codec] + 5 * ["h264"]
    recorded = frames_of(path)
    if why is not None:
        assert recorded[3].payload == RGBD.encode(frames[3])
        assert [text for text in rig.heard.texts if why in text and KEY in text]
    else:
        taken, read = decode_colour(other(3)).astype(float), recorded[3].frame().colour
        assert np.mean((decode_colour(read) - taken) ** 2) < 30.0
        assert rig.heard.texts == []
    del recorded[3]
    assert all(one.frame().colour.codec == "rgb8" for one in recorded)
    assert verify_recording(path) == []


def test_frames_without_colour_and_other_messages_pass(tmp_path: Path) -> None:
    rig = CodedRig(tmp_path)
    bare = RgbdFrame(sequence=0, time_ns=START_NS, depth=frame(0).depth)
    other = Entry(KEY.replace("rgbd", "pose"), b"", 0, 0, 0)
    apart = Entry(KEY, b"nothing", 0, 0, 0, apart=True)
    assert list(rig.coding.take(other)) == [other]
    assert list(rig.coding.take(apart)) == [apart]
    rig.record([bare])
    (recorded,) = frames_of(rig.split())
    assert recorded.payload == RGBD.encode(bare)
    assert rig.coding.counts == {}


def test_what_comes_faster_than_it_is_coded_is_recorded_as_it_came(tmp_path: Path) -> None:
    rig = CodedRig(tmp_path)
    large = [frame(n, encode_colour(picture(n, 640, 480))) for n in range(5 * MOST_WAITING)]
    rig.record(large, in_turn=False)
    path = rig.split()
    recorded = frames_of(path)
    assert [one.sequence for one in recorded] == list(range(len(large)))
    counts = rig.coding.counts
    assert counts["late"] > 0
    assert counts["coded"] > 0
    assert codecs(path).count("h264") == counts["coded"]
    assert counts["coded"] + counts["late"] + counts.get("baseless", 0) == len(large)
    assert all(one.frame().colour.width == 640 for one in recorded)
    assert verify_recording(path) == []
    assert any("takes longer than it comes" in text for text in rig.heard.texts)


def test_a_frame_waits_no_longer_than_a_crash_may_cost(tmp_path: Path) -> None:
    rig = CodedRig(tmp_path)
    huge = frame(0, encode_colour(picture(0, 1920, 1440)))
    rig.write(rig.coding.take(entry(huge)))
    rig.write(rig.coding.ready())
    assert rig.coding.under_way
    rig.now = colour_coding.LONGEST_WAIT_S
    rig.write(rig.coding.ready())
    assert not rig.coding.under_way
    time.sleep(0.01)
    rig.record(frame(number) for number in range(1, 4))
    path = rig.split()
    assert codecs(path)[0] == "jpeg"
    assert [one.frame().sequence for one in frames_of(path)] == [0, 1, 2, 3]
    assert verify_recording(path) == []


def test_without_pyav_all_is_recorded_as_it_came_and_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(__import__("sys").modules, "av", None)
    rig = CodedRig(tmp_path)
    rig.record(frame(number) for number in range(3))
    assert codecs(rig.split()) == ["jpeg"] * 3
    assert 'pip install "inhand[h264]"' in rig.heard.texts[0]
    assert rig.coding.counts == {"unfit": 3}


def test_cameras_that_somebody_invents_get_no_threads(tmp_path: Path) -> None:
    rig = CodedRig(tmp_path)
    for number in range(MOST_CODERS + 2):
        key = RGBD.key(Site(), f"invented_{number}")
        one = frame(0)
        rig.write(rig.coding.take(Entry(key, RGBD.encode(one), one.time_ns, one.time_ns, 0)))
    path = rig.split()
    assert len(frames_of(path)) == MOST_CODERS + 2
    assert codecs(path).count("jpeg") == 2
    assert len(rig.heard.texts) == 2


def test_a_paused_time_between_frames_costs_no_picture(tmp_path: Path) -> None:
    rig = CodedRig(tmp_path)
    rig.record(frame(number) for number in range(5))
    rig.write(rig.coding.all())
    rig.journal.pause(START_NS + 5 * FRAME_NS)
    rig.journal.resume(START_NS + 9 * FRAME_NS)
    rig.record(frame(number) for number in range(9, 14))
    assert min(errors_db(rig.split())) > 33.0


def test_nothing_waits_before_anything_came() -> None:
    coding = ColourCoding(Heard(), time.monotonic)
    assert not coding.under_way
    assert list(coding.all()) == list(coding.ready()) == []

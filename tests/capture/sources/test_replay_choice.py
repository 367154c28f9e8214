"""What of recordings is played, under which names and with which times."""

import time
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import msgspec
import pytest
from inhand_capture.sources.replay import ReplaySource
from inhand_runtime.source import Captured, SourceError
from inhand_schemas.messages import CameraInfo
from inhand_schemas.topics import INFO, LABEL, SKELETONS
from played import CAMERA_INFO, FRAME_NS, START_NS, Entry, entries, frame_entries, write


def play(*files: Path, **options: Any) -> list[Captured]:
    played = ReplaySource({"file": files, "rate": 0, **options}).captures(lambda: True)
    return [captured for captured in played if captured is not None]


def numbers(captured: Sequence[Captured]) -> list[int]:
    return [(each.time_ns - START_NS) // FRAME_NS for each in captured]


def split(folder: Path, *counts: int) -> list[Path]:
    """A recording of these numbers of frames a file, each of which repeats the camera's info."""
    files, begin = [], 0
    for count in counts:
        written: list[Entry] = [(INFO, "kitchen", CAMERA_INFO)]
        for number in range(begin, begin + count):
            written += frame_entries(number)
        files.append(write(folder / f"part_{len(files)}.mcap", written))
        begin += count
    return files


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """A hundred frames in two seconds."""
    return write(tmp_path / "hundred.mcap", entries(100))


@pytest.mark.parametrize(
    ("options", "frames"),
    [
        ({"start": 1.0}, range(50, 100)),
        ({"until": 0.5}, range(25)),
        ({"start": "0.5", "until": "0.6"}, range(25, 30)),
        ({"start": 0.501}, range(26, 100)),
        ({"start": "2020-09-13T12:26:41Z"}, range(50, 100)),
        ({"start": "2020-09-13T14:26:41+02:00", "until": "2020-09-13T12:26:41.1"}, range(50, 55)),
        ({"start": "2020-09-13T00:00:00"}, range(100)),
    ],
)
def test_it_plays_from_a_time_until_another(
    recording: Path, options: dict[str, Any], frames: range
) -> None:
    assert numbers(play(recording, **options)) == list(frames)


@pytest.mark.parametrize(
    ("options", "line"),
    [
        ({"start": 2}, r"start is after the end of .*, which lasts 1.980 s until 2020-09-13T12:26"),
        ({"start": 1, "until": 1}, r"until is not after 2020-09-13T12:26:41.000\+00:00, where pl"),
        ({"until": "2020-09-13T12:00:00Z"}, "until is not after"),
        ({"start": -1}, "setting options.start: "),
        ({"start": "noon"}, "'noon' is neither seconds from the begin nor a time such as 20"),
        ({"times": "later"}, "setting options.times: there is no 'later'"),
        ({"include": ["rgbd"]}, "'rgbd' is no STREAM/NAME, in which"),
        ({"include": ["pose/mug"]}, "a replay plays rgbd, skeletons, label, and not 'pose'"),
        ({"exclude": ["info/kitchen"]}, "the camera's info is always played"),
        ({"exclude": ["*/*"]}, "include and exclude leave nothing of .*, which has: label/mug, rg"),
        ({"remap": {"object/cup": "mug"}}, "no label of object 'cup' to rename; it has: mug"),
        ({"remap": {"camera/kitchen": "x"}}, "a camera has the name of its table"),
        ({"remap": {"object/mug": "My mug"}}, "object 'My mug' is no name"),
        ({"remap": {"object/a": "b", "object/c": "b"}}, "two objects cannot get one name"),
        ({"file": []}, "setting options.file"),
    ],
)
def test_what_cannot_be_played_so_is_said_before_a_start(
    recording: Path, options: dict[str, Any], line: str
) -> None:
    with pytest.raises(SourceError, match=line):
        ReplaySource({"file": str(recording), **options})


def test_streams_and_names_are_chosen_by_patterns(recording: Path) -> None:
    assert all(one.pixels is None for one in play(recording, exclude=["rgbd/*"]))
    only = play(recording, include=["*/kitchen"])
    assert all(not one.labels and one.pixels and one.people for one in only)
    labels = play(recording, include=["label/m*"])
    assert len(labels) == 100
    assert all(one.labels and one.pixels is None and one.people is None for one in labels)


def test_labels_get_the_name_that_their_object_shall_have(recording: Path) -> None:
    played = play(recording, remap={"object/mug": "cup"})
    assert {label.object for one in played for label in one.labels} == {"cup"}


def test_split_files_are_played_as_one_in_the_order_of_their_times(tmp_path: Path) -> None:
    first, second, third = split(tmp_path, 10, 20, 30)
    assert numbers(play(third, first, second)) == list(range(60))
    assert numbers(play(first, second, third, start=0.5, until=0.7)) == list(range(25, 35))
    source = ReplaySource({"file": [first, second, third], "rate": 0, "loop": True})
    playing = source.captures(lambda: True)
    looped = [one for one, _ in zip(playing, range(70), strict=False) if one is not None]
    assert numbers(looped) == [*range(60), *range(10)]


def test_from_one_split_file_to_the_next_no_time_is_added(tmp_path: Path) -> None:
    begin = time.monotonic()
    list(ReplaySource({"file": split(tmp_path, 5, 5, 5)}).captures(lambda: True))
    assert 14 * FRAME_NS / 1e9 - 1e-3 <= time.monotonic() - begin < 2.0


def test_files_that_are_not_one_recording_are_refused(tmp_path: Path) -> None:
    first, second = split(tmp_path, 3, 3)
    with pytest.raises(SourceError, match="is named twice"):
        play(first, second, first)
    wider = msgspec.structs.replace(CAMERA_INFO, fx=60.0)
    other = write(tmp_path / "other.mcap", [(INFO, "kitchen", wider), *frame_entries(9)])
    with pytest.raises(SourceError, match=r"sees otherwise in .*other\.mcap than"):
        play(first, other)
    second.write_bytes(second.read_bytes()[:2000])
    with pytest.raises(SourceError, match=r"part_1\.mcap was cut off: `inhand recording recover"):
        play(first, second)


@pytest.mark.parametrize(
    ("written", "line"),
    [
        ([(INFO, "kitchen", CAMERA_INFO)], "holds no frame, skeleton or label of camera 'kitchen'"),
        ([], "holds no camera's info: choose another recording"),
        (
            [(INFO, "kitchen", CAMERA_INFO), *entries(2, without=(INFO, LABEL), camera="side")],
            "holds no frame, skeleton or label of camera 'kitchen'",
        ),
    ],
    ids=["no frame", "nothing", "of another camera only"],
)
def test_a_recording_without_frames_is_refused_in_clear_words(
    tmp_path: Path, written: list[Entry], line: str
) -> None:
    path = write(tmp_path / "none.mcap", written)
    with pytest.raises(SourceError, match=line):
        ReplaySource({"file": path})


def test_an_empty_file_is_refused_in_clear_words(tmp_path: Path) -> None:
    path = tmp_path / "empty.mcap"
    path.touch()
    with pytest.raises(SourceError, match="is empty: nothing was recorded into it; delete it"):
        ReplaySource({"file": path})


def test_times_of_now_are_as_far_apart_as_the_captures_were(recording: Path) -> None:
    source = ReplaySource({"file": recording, "times": "now", "until": 0.5})
    before_ns = time.time_ns()
    played = [(time.time_ns(), one) for one in source.captures(lambda: True) if one is not None]
    late_ns = [now_ns - one.time_ns for now_ns, one in played]
    assert played[0][1].time_ns >= before_ns - 1_000_000
    assert all(-1_000_000 <= one < 500_000_000 for one in late_ns)
    times = [one.time_ns for _, one in played]
    steps = [after - before for before, after in pairwise(times)]
    assert sorted(steps)[len(steps) // 2] == pytest.approx(FRAME_NS, abs=1000)


def test_times_of_now_never_stand_still_nor_go_back(recording: Path) -> None:
    times = [one.time_ns for one in play(recording, times="now")]
    assert all(after > before for before, after in pairwise(times))


def test_with_the_times_of_now_the_camera_says_that_it_is_a_replay(recording: Path) -> None:
    info: CameraInfo = ReplaySource({"file": recording, "times": "now"}).info
    assert info.time_ns == 0
    assert info.description == "replay of hundred.mcap, captured 2020-09-13T12:26:40Z"
    assert ReplaySource({"file": recording}).info == CAMERA_INFO


def test_a_stream_alone_is_a_recording_too(tmp_path: Path) -> None:
    path = write(tmp_path / "frames.mcap", entries(5, without=(SKELETONS, LABEL)))
    assert numbers(play(path)) == list(range(5))

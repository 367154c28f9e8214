"""When files begin and end, and what a failing disk costs."""

from pathlib import Path

import pytest
from inhand_recorder.gaps import GapReporter
from inhand_recorder.journal import PAUSES_RECORD, Journal
from inhand_recorder.losses import LOSSES_RECORD, Losses, parse_losses
from inhand_recorder.recording_file import Entry, Limits
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import RecordingError, read_metadata, read_recording
from inhand_schemas.keys import Site
from inhand_schemas.messages import CameraInfo, ColourImage, RgbdFrame
from inhand_schemas.topics import INFO, RGBD

SECOND_NS = 1_000_000_000
START_NS = 1_700_000_000 * SECOND_NS
FRAME_BYTES = 400_000
INFO_KEY = INFO.key(Site(), "front")
RGBD_KEY = RGBD.key(Site(), "front")


def info() -> Entry:
    message = CameraInfo(
        sequence=0, time_ns=START_NS, width=64, height=48, fx=50.0, fy=50.0, cx=32.0, cy=24.0
    )
    return Entry(INFO_KEY, INFO.encode(message), START_NS, START_NS, 0, kept=True)


def frame(number: int, size: int = FRAME_BYTES, *, after_s: float = 0.0) -> Entry:
    time_ns = START_NS + int(after_s * SECOND_NS) + number
    pixels = ColourImage("jpeg", 64, 48, bytes(size))
    message = RgbdFrame(sequence=number, time_ns=time_ns, colour=pixels)
    return Entry(RGBD_KEY, RGBD.encode(message), time_ns, time_ns, number)


def journal(folder: Path, split_seconds: float = 0.0) -> Journal:
    return Journal(folder, "rig", Limits(split_seconds=split_seconds), dict)


def numbers(folder: Path, key: str = RGBD_KEY) -> list[list[int]]:
    """The numbers of a key's messages, file by file."""
    return [
        [m.sequence for m in read_recording(path) if m.key == key]
        for path in sorted(folder.glob("*.mcap"))
    ]


def test_files_are_named_by_rig_and_time_and_never_overwritten(tmp_path: Path) -> None:
    for number in range(2):
        one = journal(tmp_path)
        one.write(frame(number))
        one.close()
    names = [path.name for path in sorted(tmp_path.iterdir())]
    assert names == ["rig_20231114T221320Z.mcap", "rig_20231114T221320Z_2.mcap"]


def test_no_message_makes_no_file(tmp_path: Path) -> None:
    one = journal(tmp_path)
    one.sync()
    one.close()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("clock_set_by_s", [0.0, -3600.0, 3600.0])
def test_a_new_file_begins_after_the_time_limit_and_repeats_the_calibration(
    tmp_path: Path, clock_set_by_s: float
) -> None:
    passed = [0.0]
    limits = Limits(split_seconds=60.0)
    one = Journal(tmp_path, "rig", limits, dict, clock=lambda: passed[0])
    one.write(info())
    for number in range(5):
        passed[0] = 20.0 * number
        one.write(frame(number, after_s=20.0 * number + (clock_set_by_s if number > 1 else 0.0)))
    one.close()
    assert sorted(numbers(tmp_path)) == [[0, 1, 2], [3, 4]]
    assert numbers(tmp_path, INFO_KEY) == [[0], [0]]
    if clock_set_by_s == 0.0:
        assert [verify_recording(path) for path in tmp_path.iterdir()] == [[], []]


def test_each_file_tells_its_own_losses_and_drops(tmp_path: Path) -> None:
    drops: dict[str, int] = {}
    one = Journal(tmp_path, "rig", Limits(split_bytes=1 << 20), lambda: drops)
    for number in (0, 1, 3, 4):
        one.write(frame(number))
    drops[RGBD_KEY] = 1
    for number in (5, 6, 7, 9):
        one.write(frame(number))
    drops[RGBD_KEY] = 2
    one.close()
    told = [
        parse_losses(read_metadata(path)[LOSSES_RECORD])[RGBD_KEY]
        for path in sorted(tmp_path.iterdir())
    ]
    assert sum(losses.lost for losses in told) == 2
    assert sum(losses.dropped for losses in told) == 2


def test_a_pause_makes_the_file_whole_and_both_files_around_it_say_when_it_was(
    tmp_path: Path,
) -> None:
    drops: dict[str, int] = {}
    one = Journal(tmp_path, "rig", Limits(), lambda: drops)
    one.write(frame(0))
    whole = one.pause(START_NS + 10)
    assert whole is not None
    assert numbers(tmp_path) == [[0]]
    one.write(info())
    one.write(frame(1))
    drops[RGBD_KEY] = 7
    one.sync()
    assert list(tmp_path.iterdir()) == [whole]
    one.resume(START_NS + 20)
    one.write(frame(2))
    one.close()
    assert numbers(tmp_path) == [[0], [2]]
    assert numbers(tmp_path, INFO_KEY) == [[], [0]]
    before, after = (read_metadata(path) for path in sorted(tmp_path.iterdir()))
    assert before[PAUSES_RECORD] == {str(START_NS + 10): ""}
    assert after[PAUSES_RECORD] == {str(START_NS + 10): str(START_NS + 20)}
    assert parse_losses(after[LOSSES_RECORD])[RGBD_KEY] == Losses(received=1)


def test_a_file_after_which_nobody_paused_says_nothing_of_pauses(tmp_path: Path) -> None:
    one = journal(tmp_path)
    one.pause(START_NS)
    one.resume(START_NS + 5)
    for number in range(2):
        one.write(frame(number))
        one.close()
    first, second = (read_metadata(path) for path in sorted(tmp_path.iterdir()))
    assert PAUSES_RECORD in first
    assert PAUSES_RECORD not in second


def test_what_a_failed_file_held_only_in_memory_goes_into_the_next(tmp_path: Path) -> None:
    folder = tmp_path / "disk"
    one = journal(folder)
    one.write(info())
    one.write(frame(0))
    one.sync()
    one.write(frame(1, 1000))
    next(folder.iterdir()).unlink()
    with pytest.raises(RecordingError, match="was removed while it was written"):
        one.sync()
    assert one.waiting == {RGBD_KEY: 1}
    one.write(frame(2, 1000))
    one.close()
    assert numbers(folder) == [[1, 2]]
    assert numbers(folder, INFO_KEY) == [[0]]


def test_calibration_that_a_failed_file_gave_back_is_not_written_twice(tmp_path: Path) -> None:
    folder = tmp_path / "disk"
    one = journal(folder)
    one.write(info())
    next(folder.iterdir()).unlink()
    with pytest.raises(RecordingError):
        one.sync()
    one.close()
    assert numbers(folder, INFO_KEY) == [[0]]


def test_a_folder_that_cannot_be_made_loses_nothing_that_was_handed_in(tmp_path: Path) -> None:
    folder = tmp_path / "disk"
    folder.write_text("in the way")
    one = journal(folder)
    for number in range(3):
        with pytest.raises(
            RecordingError, match=r"cannot create .*: bring its disk or folder back"
        ):
            one.write(frame(number))
    folder.unlink()
    one.close()
    assert numbers(folder) == [[0, 1, 2]]


def test_missing_messages_are_told_each_time_that_their_count_doubled() -> None:
    lines: list[str] = []
    teller = GapReporter(lines.append)
    for number in range(0, 20, 2):
        teller.count(RGBD_KEY, number)
        teller.report()
    assert [int(line.split()[0]) for line in lines] == [1, 2, 4, 8]

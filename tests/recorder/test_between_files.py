"""What is missing between two files of a recorder is counted in the second one."""

from pathlib import Path

from inhand_recorder.journal import Journal
from inhand_recorder.losses import LOSSES_RECORD, Losses, parse_losses
from inhand_recorder.recording_file import Entry, Limits
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import read_metadata
from recordings import POSE_KEY, START_NS, frame_messages


def test_numbers_that_are_missing_between_two_files_are_counted(tmp_path: Path) -> None:
    journal = Journal(tmp_path, "rig", Limits(), dict)
    for number in (0, 1, 5, 6):
        journal.write(entry(number))
        if number == 1:
            journal.close()
    second = journal.close()
    assert second is not None
    assert losses_of(second) == Losses(received=2, before=3)
    assert [one for one in verify_recording(second) if "camera info" not in one] == []


def test_what_came_while_paused_is_not_missing(tmp_path: Path) -> None:
    journal = Journal(tmp_path, "rig", Limits(), dict)
    journal.write(entry(0))
    journal.pause(START_NS)
    journal.write(entry(1))
    journal.resume(START_NS)
    journal.write(entry(2))
    second = journal.close()
    assert second is not None
    assert losses_of(second) == Losses(received=1)


def entry(number: int) -> Entry:
    """The pose of a frame, as a recorder received it."""
    key, message, payload = frame_messages(number, 1)[2]
    return Entry(key, payload, message.time_ns, message.time_ns, number)


def losses_of(path: Path) -> Losses:
    """What a file says of the poses."""
    return parse_losses(read_metadata(path)[LOSSES_RECORD])[POSE_KEY]

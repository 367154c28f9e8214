"""What `inhand recorder status` says of a recorder."""

import pytest
from inhand_runtime.exit_codes import FAILED
from inhand_schemas.messages import RecordingState
from inhand_schemas.procedures import RecorderReply

from inhand.asking import conclude
from inhand.recorder_asking import reply_text


def test_what_the_folder_takes_and_no_quota_deletes_is_said() -> None:
    state = RecordingState(
        paused=True,
        folder_bytes=3_000_000_000,
        unmanaged=2,
        unmanaged_bytes=1_200_000_000,
        clips_bytes=250_000_000,
    )
    assert reply_text(RecorderReply(recorder="disk", recording=state)) == (
        "paused; all recordings take 3.0 GB; no quota deletes 2 recordings, 1.2 GB, which no "
        "recorder of this release or a later one has written; clips take 250.0 MB"
    )


def test_a_problem_of_another_program_does_nothing_to_the_terminal(
    capsys: pytest.CaptureFixture[str],
) -> None:
    reply = RecorderReply(
        recorder="disk", recording=RecordingState(paused=False), problem="no\x1b[2J disk\n"
    )
    assert conclude({"disk": reply}, ["disk"], "recorders", None) == FAILED
    assert capsys.readouterr().out == "WRONG: disk: no\\x1b[2J disk\\n\n"

"""What `inhand recorder status` says of a recorder."""

from inhand_schemas.messages import RecordingState
from inhand_schemas.procedures import RecorderReply

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

"""What a recorder is asked to do."""

import json
import threading

import pytest
from inhand_recorder.commands import CommandDesk
from inhand_recorder.journal import PAUSES_RECORD
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import read_metadata
from inhand_schemas.messages import RecordingState
from inhand_schemas.procedures import RecorderReply, RecorderRequest
from running_recorder import frames_in, numbers, recordings, start_recorder
from running_rig import RunningRig, eventually


def test_requests_of_one_id_are_done_once_and_those_for_another_recorder_not_at_all() -> None:
    desk, done = CommandDesk("disk"), list[str]()
    end = threading.Event()

    def do(verb: str) -> RecorderReply:
        done.append(verb)
        return RecorderReply(recorder="disk", recording=RecordingState())

    def serve() -> None:
        while not end.wait(0.001):
            desk.serve(do)

    thread = threading.Thread(target=serve)
    thread.start()
    replies = [desk.ask("split", RecorderRequest(id=name)) for name in ("a", "a", "b")]
    assert desk.ask("split", RecorderRequest(id="c", recorder="other")) is None
    end.set()
    thread.join()
    assert None not in replies
    assert done == ["split", "split"]


@pytest.mark.long
def test_one_that_starts_paused_records_only_between_resume_and_pause(rig: RunningRig) -> None:
    start_recorder(rig, "start_paused = true")
    rig.publisher("--frame-bytes", "1000")

    def ask(verb: str) -> str:
        asked = rig.done("recorder", verb, "--config", rig.config)
        assert asked.popen.returncode == 0, asked.stderr + asked.stdout
        return asked.stdout

    assert "disk: paused" in ask("status")
    shown = rig.done("status", "--config", rig.config).stdout
    assert "paused" in shown.split("recorder disk: ")[0]
    assert "recorder disk: paused: nothing is recorded until `inhand recorder resume" in shown
    assert recordings(rig, "*") == []
    ask("resume")
    eventually("10 frames on the disk", lambda: frames_in(rig) >= 10)
    assert ".mcap is whole" in ask("split")
    (first,) = recordings(rig)
    eventually("10 more frames", lambda: frames_in(rig) >= len(numbers([first])) + 10)
    assert "paused; " in ask("pause")
    paths = sorted(recordings(rig), key=lambda path: numbers([path])[0])
    written = numbers(paths)
    assert written == list(range(written[0], written[-1] + 1))
    assert written[0] > 0
    assert [verify_recording(path) for path in paths] == [[], []]
    assert [PAUSES_RECORD in read_metadata(path) for path in paths] == [True, True]


@pytest.mark.long
def test_a_recorder_that_does_not_run_is_named_and_written_for_machines(rig: RunningRig) -> None:
    rig.configure('[recorder.disk]\nfolder = "disk"')
    path = rig.folder / "asked.json"
    asked = ("recorder", "status", "--config", rig.config, "--seconds", "0.2", "--json", path)
    missed = rig.done(*asked)
    assert missed.popen.returncode == 1
    assert "WRONG: disk does not answer: " in missed.stdout
    assert json.loads(path.read_text())["recorders"] == []
    wrong = rig.done(*asked, "--name", "dsk")
    assert wrong.popen.returncode == 2
    assert "no table [recorder.dsk] (did you mean disk?)" in wrong.stderr

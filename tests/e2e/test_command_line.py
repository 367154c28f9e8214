"""The command line as people and scripts use it."""

import json
import signal
from collections.abc import Callable
from pathlib import Path

import psutil
import pytest
from inhand_recorder.inspection import inspect_recording
from inhand_recorder.losses import LOSSES_RECORD, LossCounter, format_losses
from inhand_runtime.recording import RecordingWriter, read_recording
from inhand_schemas.keys import Site
from inhand_schemas.messages import CameraInfo, ObjectPose
from inhand_schemas.topics import INFO, POSE, RGBD
from manager_stand_in import Manager
from running_rig import RunningRig, eventually

from inhand.__main__ import DAEMONS, VERBS, main

POSE_KEY = POSE.key(Site(), "mug")
RGBD_KEY = RGBD.key(Site(), "front")


@pytest.mark.parametrize("verb", [*DAEMONS, *VERBS])
def test_every_verb_has_help(verb: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main([verb, "--help"])
    assert end.value.code == 0
    assert f"usage: inhand {verb}" in capsys.readouterr().out


def test_the_release_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(["--version"])
    assert end.value.code == 0
    assert capsys.readouterr().out.startswith("inhand 0.")


def test_the_help_lists_every_verb(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(["--help"])
    assert end.value.code == 0
    told = capsys.readouterr().out
    assert all(f"  {verb} " in told for verb in (*DAEMONS, *VERBS))


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["juggle"],
        ["recorder", "--nonsense"],
        ["recording"],
        ["recording", "polish", "a.mcap"],
        ["recording", "info"],
        ["echo", "--count", "many"],
        ["rate", "--seconds", "-1"],
        ["replay"],
    ],
)
def test_wrong_usage_ends_with_2(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(arguments)
    assert end.value.code == 2
    assert "usage: inhand" in capsys.readouterr().err


def test_an_unknown_stream_is_one_line_that_lists_the_streams(
    rig: RunningRig, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["echo", "poses", "--config", str(rig.config)]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("inhand echo: there is no stream 'poses'; there are: info, rgbd")


def test_an_unknown_setting_is_one_line_with_its_place(
    rig: RunningRig, capsys: pytest.CaptureFixture[str]
) -> None:
    rig.configure('[recorder.disk]\nfoldr = "x"')
    assert main(["recorder", "--config", str(rig.config), "--check-config"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line == (
        f"recorder: {rig.config}:2: unknown setting recorder.disk.foldr (did you mean folder?)"
    )


START_NS = 1_700_000_000_000_000_000


def write_recording(path: Path, *, whole: bool = True) -> Path:
    """Ten poses; when not ``whole``, as ``kill -9`` leaves them. Returns the file."""
    counter = LossCounter()
    writer = RecordingWriter(path)
    for number in range(10):
        time_ns = START_NS + number * 33_000_000
        pose = ObjectPose(
            sequence=number,
            time_ns=time_ns,
            object="mug",
            camera="front",
            state="lost",
            confidence=0.0,
        )
        counter.count(POSE_KEY, number)
        writer.write(
            POSE_KEY, POSE.encode(pose), received_ns=time_ns, captured_ns=time_ns, sequence=number
        )
    writer.sync()
    left = path.with_name(path.name + ".part").read_bytes()
    writer.add_metadata(LOSSES_RECORD, format_losses(counter.losses()))
    writer.close()
    if not whole:
        path.unlink()
        path = path.with_name(path.name + ".part")
        path.write_bytes(left)
    return path


def test_recording_info_tells_what_is_in_it(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "a.mcap")
    result = tmp_path / "info.json"
    assert main(["recording", "info", str(path), "--json", str(result)]) == 0
    (info,) = json.loads(result.read_text())["recordings"]
    assert info["complete"]
    assert info["keys"][POSE_KEY]["messages"] == 10
    assert info["metadata"][LOSSES_RECORD][POSE_KEY].startswith("received=10 lost=0")


def test_recording_verify_ends_with_1_for_a_cut_file_and_recover_saves_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    whole = write_recording(tmp_path / "whole.mcap")
    cut = write_recording(tmp_path / "cut.mcap", whole=False)
    assert main(["recording", "verify", str(whole)]) == 0
    assert main(["recording", "verify", str(whole), str(cut)]) == 1
    assert f"inhand recording recover {cut}" in capsys.readouterr().out
    assert main(["recording", "recover", str(cut)]) == 0
    assert "10 messages of 1 key;" in capsys.readouterr().out
    assert main(["recording", "verify", str(tmp_path / "cut.recovered.mcap")]) == 0


def test_one_output_for_two_recordings_is_wrong_usage(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["recording", "recover", "a.mcap", "b.mcap", "-o", str(tmp_path / "c.mcap")]) == 2
    assert "leave -o out" in capsys.readouterr().err


def test_a_missing_recording_is_one_line_and_exit_code_1(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["recording", "info", str(tmp_path / "none.mcap")]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line == f"inhand recording: {tmp_path / 'none.mcap'} does not exist: check the path"


@pytest.mark.long
@pytest.mark.parametrize("verb", ["topics", "echo", "rate", "status"])
def test_a_silent_site_is_one_line_and_exit_code_1(rig: RunningRig, verb: str) -> None:
    looked = rig.done(verb, "--config", rig.config, "--seconds", "0.5")
    assert looked.popen.returncode == 1
    (line,) = looked.stderr.splitlines()
    assert line.startswith(f"inhand {verb}: nothing answered from rig 'rig'")
    assert "inhand up" in line


@pytest.mark.long
def test_topics_lists_what_is_published_and_tells_other_versions(rig: RunningRig) -> None:
    rig.publisher("--newer")
    result = rig.folder / "topics.json"
    looked = rig.done("topics", "--config", rig.config, "--seconds", "4", "--json", result)
    assert looked.popen.returncode == 0, looked.stderr
    topics = {topic["key"]: topic for topic in json.loads(result.read_text())["topics"]}
    types = {key: topic["type"] for key, topic in topics.items() if topic["remark"] is None}
    assert types == {
        "inhand/@v1/rig/info/front": "CameraInfo",
        "inhand/@v1/rig/pose/mug": "ObjectPose",
        "inhand/@v1/rig/rgbd/front": "RgbdFrame",
    }
    remark = topics["inhand/@v2/rig/pose/mug"]["remark"]
    assert "is of version 2, and this release reads version 1: update the older side" in remark
    assert "ObjectPose.v2" in topics["inhand/@v1/rig/pose/newer"]["remark"]


@pytest.mark.long
def test_echo_prints_messages_with_sizes_for_bytes(rig: RunningRig) -> None:
    rig.publisher("--frame-bytes", "1234")
    # The publisher waits until both are wanted.
    rig.inhand("echo", "pose/mug", "--config", rig.config)
    looked = rig.done("echo", "rgbd/front", "--config", rig.config, "--count", "3", "--json")
    assert looked.popen.returncode == 0, looked.stderr
    lines = [json.loads(line) for line in looked.stdout.splitlines()]
    assert [line["key"] for line in lines] == ["inhand/@v1/rig/rgbd/front"] * 3
    assert lines[0]["message"]["colour"]["data"] == "<1,234 bytes>"


@pytest.mark.long
def test_rate_measures_rates_and_gaps(rig: RunningRig) -> None:
    rig.publisher("--rate", "20", "--skip", "5")
    result = rig.folder / "rate.json"
    looked = rig.done("rate", "--config", rig.config, "--seconds", "5", "--json", result)
    assert looked.popen.returncode == 0, looked.stderr
    frames = json.loads(result.read_text())["topics"]["inhand/@v1/rig/rgbd/front"]
    assert frames["lost"] == 1
    assert 15 < frames["rate_hz"] < 21


@pytest.mark.long
def test_status_lists_the_live_instances_and_their_health(rig: RunningRig) -> None:
    rig.configure(f'[recorder.disk]\nfolder = "{rig.folder}"')
    rig.inhand("recorder", "--config", rig.config).said("is up")
    health = rig.health("disk")
    assert (health["service"], health["state"], health["last_error"]) == (
        "recorder",
        "running",
        None,
    )


@pytest.mark.long
def test_ctrl_c_ends_a_look_with_130(rig: RunningRig) -> None:
    rig.publisher()
    looking = rig.inhand("echo", "--config", rig.config, "--json")
    looking.said("rgbd/front")
    assert looking.stop(signal.SIGINT) == 130
    assert looking.stderr == ""


def test_a_recording_of_nothing_that_can_be_replayed_is_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write_recording(tmp_path / "poses.mcap")
    assert main(["replay", str(path)]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"inhand replay: {path} holds no camera's info")


@pytest.mark.parametrize(
    ("more", "line"),
    [
        ([], "holds several cameras; add --camera with one of: front, side"),
        (["--camera", "top"], "holds no camera 'top'; there are: front, side"),
    ],
)
def test_which_of_several_cameras_is_replayed_must_be_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], more: list[str], line: str
) -> None:
    path = tmp_path / "two.mcap"
    with RecordingWriter(path) as writer:
        info = INFO.encode(
            CameraInfo(
                sequence=0, time_ns=0, width=64, height=48, fx=50.0, fy=50.0, cx=32.0, cy=24.0
            )
        )
        for camera in ("front", "side"):
            key = INFO.key(Site(), camera)
            writer.write(key, info, received_ns=0, captured_ns=0, sequence=0)
    assert main(["replay", str(path), *more]) == 2
    assert capsys.readouterr().err == f"inhand replay: {path} {line}\n"


@pytest.mark.long
def test_a_replay_publishes_what_was_recorded_with_its_capture_times(rig: RunningRig) -> None:
    first = recorded(rig, "first", lambda: rig.publisher("--frames", "30"))
    again = recorded(
        rig, "again", lambda: rig.done("replay", first, "--rate", "3", "--config", rig.config)
    )
    frames = [
        [(m.captured_ns, m.message().colour) for m in read_recording(path, streams=("rgbd",))]
        for path in (first, again)
    ]
    assert len(frames[0]) == 30
    assert frames[0] == frames[1]


def recorded(rig: RunningRig, folder: str, play: Callable[[], object]) -> Path:
    """Record 30 frames that ``play`` publishes; returns the file."""
    rig.configure(f'[recorder.disk]\nfolder = "{rig.folder / folder}"')
    recorder = rig.inhand("recorder", "--config", rig.config)
    recorder.said("is up")
    play()

    def written() -> bool:
        infos = [inspect_recording(path) for path in (rig.folder / folder).glob("*")]
        return any(key.key == RGBD_KEY and key.messages == 30 for i in infos for key in i.keys)

    eventually("30 frames on the disk", written)
    assert recorder.stop() == 0
    (path,) = (rig.folder / folder).glob("*.mcap")
    return path


TWO_RECORDERS = '[recorder.a]\nfolder = "{0}/a"\n[recorder.b]\nfolder = "{0}/b"'


def children(pid: int) -> list[psutil.Process]:
    """The child processes by now."""
    return psutil.Process(pid).children(recursive=True)


@pytest.mark.long
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_up_starts_everything_and_stops_everything(rig: RunningRig, number: int) -> None:
    rig.configure(TWO_RECORDERS.format(rig.folder))
    up = rig.inhand("up", "--config", rig.config)
    up.said("recorder a is up")
    up.said("recorder b is up")
    started = children(up.pid)
    assert len(started) == 2
    assert up.stop(number) == 0
    assert "recorder a stopped" in up.stderr
    assert not any(child.is_running() for child in started)


@pytest.mark.long
def test_up_starts_a_killed_process_again(rig: RunningRig) -> None:
    rig.configure(TWO_RECORDERS.format(rig.folder))
    up = rig.inhand("up", "--config", rig.config)
    up.said("recorder a is up")
    up.said("recorder b is up")
    killed = next(child for child in children(up.pid) if "a" in child.cmdline())
    killed.kill()
    up.said("recorder a was killed by SIGKILL")
    eventually("a second start", lambda: up.stderr.count("recorder a is up") == 2)
    assert up.stop() == 0


@pytest.mark.long
def test_up_tells_systemd_once_that_all_were_started_and_feeds_its_watchdog(
    rig: RunningRig,
) -> None:
    """What systemd gives ``inhand up`` is not for its children, which would speak in its name."""
    manager = Manager(str(rig.folder / "notify"))
    rig.configure(TWO_RECORDERS.format(rig.folder))
    up = rig.inhand("up", "--config", rig.config, **manager.environment())
    eventually("it is up", lambda: "READY=1" in manager.heard())
    eventually("both run", lambda: "STATUS=2 of 2 processes run" in manager.heard())
    up.said("recorder a is up")
    fed = manager.beats()
    next(child for child in children(up.pid) if "a" in child.cmdline()).kill()
    eventually("one is missing", lambda: "STATUS=1 of 2 processes run" in manager.heard())
    eventually("the watchdog is fed", lambda: manager.beats() > fed)
    assert up.stop() == 0
    assert manager.heard().count("READY=1") == manager.heard().count("STOPPING=1") == 1
    assert not any("running" in said for said in manager.heard())
    manager.close()


@pytest.mark.long
def test_up_stops_what_publishes_before_what_records_so_that_nothing_is_lost(
    rig: RunningRig,
) -> None:
    played = recorded(rig, "first", lambda: rig.publisher("--frames", "30"))
    rig.configure(
        f'[capture.front]\nsource = "replay"\noptions = {{ file = "{played}", loop = true }}\n'
        f'[recorder.disk]\nfolder = "{rig.folder}/again"'
    )
    up = rig.inhand("up", "--config", rig.config)
    up.said("recorder disk is up")
    eventually("a file", lambda: list((rig.folder / "again").glob("*.part")))
    eventually("60 frames", lambda: rig.counted("front", RGBD_KEY, "published") >= 60)
    assert up.stop() == 0
    (path,) = (rig.folder / "again").glob("*.mcap")
    last_words = [m.message() for m in read_recording(path, streams=("health",))]
    (front,) = (h for h in last_words if h.instance == "front" and h.state == "stopping")
    frames = list(read_recording(path, streams=("rgbd",)))
    assert len(frames) == front.topics[RGBD_KEY].published


@pytest.mark.long
def test_up_ends_with_0_when_all_has_come_to_its_end(rig: RunningRig) -> None:
    played = recorded(rig, "first", lambda: rig.publisher("--frames", "30"))
    rig.configure(f'[capture.front]\nsource = "replay"\noptions.file = "{played}"')
    up = rig.inhand("up", "--config", rig.config)
    assert up.wait() == 0
    assert "capture front ended with exit code 0" in up.stderr


@pytest.mark.long
def test_even_a_killed_up_leaves_no_orphans(rig: RunningRig) -> None:
    rig.configure(TWO_RECORDERS.format(rig.folder))
    up = rig.inhand("up", "--config", rig.config)
    up.said("recorder a is up")
    up.said("recorder b is up")
    started = children(up.pid)
    up.stop(signal.SIGKILL)
    gone, alive = psutil.wait_procs(started, timeout=30)
    assert (len(gone), alive) == (2, [])


@pytest.mark.long
def test_up_stops_everything_when_one_has_wrong_settings(rig: RunningRig) -> None:
    rig.configure(TWO_RECORDERS.format(rig.folder) + '\n[recorder.c]\nfolder = "/proc/nowhere"')
    up = rig.inhand("up", "--config", rig.config)
    assert up.wait() == 2
    assert "cannot write to the folder /proc/nowhere" in up.stderr
    assert "recorder c has wrong settings" in up.stderr


def test_up_without_anything_to_run_is_wrong_settings(
    rig: RunningRig, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["up", "--config", str(rig.config)]) == 2
    assert "names no process: add a table such as [capture.front]" in capsys.readouterr().err

"""The recorder as a process, over real Zenoh and on real disks."""

import resource
import shutil
import signal
import time

import pytest
from inhand_recorder.inspection import inspect_recording
from inhand_recorder.losses import LOSSES_RECORD, Losses, parse_losses
from inhand_recorder.verification import examine_recording, verify_recording
from inhand_runtime.recording import read_metadata, read_recording
from inhand_schemas.keys import Site
from inhand_schemas.messages import ColourImage, RgbdFrame
from inhand_schemas.topics import INFO, POSE, RGBD
from recordings import flaws
from running_recorder import RGBD_KEY, frames_in, numbers, recordings, start_recorder
from running_rig import RunningRig, eventually
from wire import Wire

INFO_KEY = INFO.key(Site(), "front")
POSE_KEY = POSE.key(Site(), "mug")

pytestmark = pytest.mark.long


def test_every_large_frame_at_30_hz_is_recorded(rig: RunningRig) -> None:
    recorder = start_recorder(rig)
    rig.publisher("--frames", "90", "--frame-bytes", "400000")
    eventually("90 frames on the disk", lambda: frames_in(rig) == 90)
    assert recorder.stop() == 0
    (path,) = recordings(rig)
    assert numbers([path]) == list(range(90))
    assert numbers([path], POSE_KEY) == list(range(90))
    assert verify_recording(path) == []
    losses = parse_losses(read_metadata(path)[LOSSES_RECORD])
    assert losses[RGBD_KEY] == Losses(received=90)


def test_sigterm_finishes_the_file_within_two_seconds(rig: RunningRig) -> None:
    recorder = start_recorder(rig)
    rig.publisher("--frame-bytes", "400000")
    eventually("30 frames on the disk", lambda: frames_in(rig) >= 30)
    start = time.monotonic()
    assert recorder.stop() == 0
    assert time.monotonic() - start < 2.0
    assert recordings(rig, "*.part") == []
    (path,) = recordings(rig)
    assert path.name.startswith("rig_2")
    assert verify_recording(path) == []


@pytest.mark.parametrize("colour", ["published", "h264"])
def test_kill_9_loses_half_a_second_at_the_most_and_recover_saves_the_rest(
    rig: RunningRig, colour: str
) -> None:
    recorder = start_recorder(rig, f'colour = "{colour}"')
    rig.publisher("--pictures")
    eventually("60 frames on the disk", lambda: frames_in(rig) >= 60)
    killed_ns = time.time_ns()
    assert recorder.stop(signal.SIGKILL) == -signal.SIGKILL
    (part,) = recordings(rig, "*.part")
    saved = rig.folder / "saved.mcap"
    recover = rig.done("recording", "recover", part, "-o", saved)
    assert recover.popen.returncode == 0, recover.stderr
    assert verify_recording(saved) == []
    frames = [m for m in read_recording(saved) if m.key == RGBD_KEY]
    assert [frame.sequence for frame in frames] == list(range(len(frames)))
    assert killed_ns - frames[-1].received_ns < 0.5e9  # a quarter where the machine is not busy
    assert any(frame.coded for frame in frames) == (colour == "h264")
    assert all(frame.message() for frame in frames)


def test_split_files_with_h264_stand_alone_and_what_is_no_picture_is_said(
    rig: RunningRig, wire: Wire
) -> None:
    recorder = start_recorder(rig, 'colour = "h264"\nsplit_seconds = 1')
    rig.publisher("--frames", "60", "--pictures")
    eventually("60 frames on the disk", lambda: frames_in(rig) == 60)
    attic = wire.publisher(RGBD, "attic")
    eventually("the recorder listens", attic.wanted)
    image = ColourImage("jpeg", 64, 48, b"no picture")
    attic.put(RgbdFrame(sequence=0, time_ns=time.time_ns(), colour=image))
    told = f"{RGBD_KEY.replace('front', 'attic')}: colour is recorded as it came: damaged JPEG"
    recorder.said(told)
    reply = rig.done("recorder", "status", "--config", rig.config)
    assert "colour as H.264" in reply.stdout
    assert recorder.stop() == 0
    paths = sorted(recordings(rig), key=lambda path: inspect_recording(path).start_ns)
    assert len(paths) >= 2
    assert numbers(paths) == list(range(60))
    for path in paths:
        assert [line for line in verify_recording(path) if "attic" not in line] == []
        frames = [one for one in read_recording(path) if one.key == RGBD_KEY]
        assert all(one.message() for one in frames)
    assert any(one.coded for path in paths for one in read_recording(path))


def test_a_recorder_that_starts_late_still_gets_the_calibration(rig: RunningRig) -> None:
    rig.publisher("--frames", "5")
    recorder = start_recorder(rig)
    eventually("5 frames on the disk", lambda: frames_in(rig) == 5)
    assert recorder.stop() == 0
    assert numbers(recordings(rig), INFO_KEY) == [0]


def test_every_split_file_stands_alone_and_none_loses_a_frame(rig: RunningRig) -> None:
    recorder = start_recorder(rig, 'split_bytes = "2MiB"')
    rig.publisher("--frames", "60", "--frame-bytes", "100000")
    eventually("60 frames on the disk", lambda: frames_in(rig) == 60)
    assert recorder.stop() == 0
    paths = sorted(recordings(rig), key=lambda path: inspect_recording(path).start_ns)
    assert len(paths) >= 3
    assert numbers(paths) == list(range(60))
    assert numbers(paths, INFO_KEY) == [0] * len(paths)
    assert [verify_recording(path) for path in paths] == [[]] * len(paths)


def test_frames_that_never_came_are_told_and_written_into_the_file(rig: RunningRig) -> None:
    recorder = start_recorder(rig)
    rig.publisher("--frames", "20", "--skip", "7", "--skip", "8")
    eventually("18 frames on the disk", lambda: frames_in(rig) == 18)
    recorder.said(f"2 messages of {RGBD_KEY} missing so far")
    assert recorder.stop() == 0
    losses = parse_losses(read_metadata(recordings(rig)[0])[LOSSES_RECORD])
    assert losses[RGBD_KEY] == Losses(received=18, lost=2)


def test_what_cannot_be_read_is_counted_told_once_a_kind_and_kept_apart(
    rig: RunningRig, wire: Wire
) -> None:
    recorder = start_recorder(rig)
    frames = wire.publisher(RGBD, "front")
    eventually("the recorder listens", frames.wanted)
    for _ in range(3):
        wire.session.put(RGBD_KEY, b"garbage", encoding=RGBD.encoding)
        wire.session.put(RGBD_KEY, b"\x80", encoding=RGBD.encoding.replace("v1", "v2"))
    frames.put(RgbdFrame(sequence=0, time_ns=time.time_ns()))
    eventually("the frame on the disk", lambda: frames_in(rig) == 1)
    assert rig.counted("disk", RGBD_KEY, "malformed") == 6
    assert recorder.stderr.count("no valid RgbdFrame") == 1
    assert recorder.stderr.count("RgbdFrame comes in version 2") == 1
    assert recorder.stop() == 0
    (path,) = recordings(rig, "*.mcap")
    assert len(list(read_recording(path, streams=["rgbd"]))) == 1
    assert any("kept apart, as undecodable: 6 messages" in n for n in examine_recording(path).notes)
    assert flaws(path) == []


def test_a_full_disk_is_told_and_costs_nothing_once_it_is_freed(rig: RunningRig) -> None:
    recorder = start_recorder(rig)
    publisher = rig.publisher("--frame-bytes", "100000", "--frames", "200")
    eventually("30 frames on the disk", lambda: frames_in(rig) >= 30)
    resource.prlimit(recorder.pid, resource.RLIMIT_FSIZE, (1 << 16, resource.RLIM_INFINITY))
    recorder.said("saves what was written")
    recorder.said("until then what arrives waits in memory")
    health = eventually("degraded", lambda: degraded(rig))
    assert "make room or use another disk; until then" in health["last_error"]
    unlimited = (resource.RLIM_INFINITY, resource.RLIM_INFINITY)
    resource.prlimit(recorder.pid, resource.RLIMIT_FSIZE, unlimited)
    publisher.said("published 200")
    eventually("running again", lambda: rig.health("disk")["state"] == "running")
    assert recorder.stop() == 0
    (part,) = recordings(rig, "*.part")  # the failed retries left none
    saved = rig.folder / "saved.mcap"
    assert rig.done("recording", "recover", part, "-o", saved).popen.returncode == 0
    assert sorted({*numbers([saved]), *numbers(recordings(rig))}) == list(range(200))


def degraded(rig: RunningRig) -> dict[str, object] | None:
    """The health of the recorder when it says that it is degraded."""
    health = rig.health("disk")
    return health if health["state"] == "degraded" else None


def test_a_folder_that_vanishes_is_told_and_recording_goes_on(rig: RunningRig) -> None:
    recorder = start_recorder(rig)
    rig.publisher("--frame-bytes", "1000")
    eventually("10 frames on the disk", lambda: frames_in(rig) >= 10)
    shutil.rmtree(rig.folder / "disk")
    recorder.said("was removed while it was written")
    eventually("10 frames in a new file", lambda: frames_in(rig) >= 10)
    assert recorder.stop() == 0
    (path,) = recordings(rig)
    assert verify_recording(path) == []
    assert numbers([path], INFO_KEY) == [0]


@pytest.mark.parametrize("folder", ["/proc/nowhere", "/dev/null/recordings"])
def test_an_unwritable_folder_is_one_line_and_exit_code_2(rig: RunningRig, folder: str) -> None:
    rig.configure(f'[recorder.disk]\nfolder = "{folder}"')
    recorder = rig.done("recorder", "--config", rig.config)
    assert recorder.popen.returncode == 2
    (line,) = recorder.stderr.splitlines()
    assert line.startswith(f"recorder: cannot write to the folder {folder}: ")
    assert line.endswith("change folder in the recorder's settings")

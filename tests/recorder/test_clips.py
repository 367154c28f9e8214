"""Clips of the last seconds, and of the seconds after."""

import os
import time
from pathlib import Path

import pytest
from inhand_recorder.clips import CLIP_RECORD, Clips, ClipsFolder
from inhand_recorder.recording_file import Entry
from inhand_recorder.ring import RingBounds
from inhand_recorder.verification import verify_recording
from inhand_runtime.recording import read_metadata, read_recording
from inhand_schemas.keys import Site
from inhand_schemas.messages import CameraInfo, ColourImage, Event, RgbdFrame
from inhand_schemas.topics import EVENT, INFO, RGBD
from running_recorder import RGBD_KEY, frames_in, numbers, recordings, start_recorder
from running_rig import RunningRig, eventually
from wire import Wire

START_NS = 1_700_000_000_000_000_000
INFO_KEY = INFO.key(Site(), "front")
PERIOD_S = 0.1


class Run:
    """Frames at 10 Hz and the camera's info once, on a clock of the test's own."""

    def __init__(self, folder: Path, size: int = 1 << 30) -> None:
        self.problems: list[str | None] = []
        self.clips = Clips(
            ClipsFolder(folder, "rig", 2.0), RingBounds(3.0, size), self.problems.append
        )
        self.number = 0
        message = CameraInfo(
            sequence=0, time_ns=START_NS, width=64, height=48, fx=50, fy=50, cx=32, cy=24
        )
        self.clips.take(0.0, Entry(INFO_KEY, INFO.encode(message), START_NS, START_NS, 0, True))

    @property
    def now(self) -> float:
        return self.number * PERIOD_S

    @property
    def now_ns(self) -> int:
        return START_NS + round(self.now * 1e9)

    def frames(self, count: int, *, written: bool = True) -> None:
        for _ in range(count):
            self.number += 1
            pixels = ColourImage("jpeg", 64, 48, os.urandom(1000))
            message = RgbdFrame(sequence=self.number, time_ns=self.now_ns, colour=pixels)
            payload = RGBD.encode(message)
            entry = Entry(RGBD_KEY, payload, self.now_ns, self.now_ns, self.number)
            self.clips.take(self.now, entry)
            if written:
                self.clips.step(self.now, all_came=False)

    def trigger(self, why: str = "snapshot") -> str:
        return self.clips.trigger(why, self.now_ns, self.now)


def clips(folder: Path) -> list[Path]:
    return sorted(folder.iterdir()) if folder.exists() else []


def test_a_clip_holds_each_frame_from_before_to_after_and_the_info_of_long_ago(
    tmp_path: Path,
) -> None:
    run = Run(tmp_path / "clips")
    run.frames(100)
    assert run.trigger() == "rig_20231114T221330Z.mcap"
    run.frames(40)
    (path,) = clips(tmp_path / "clips")
    assert numbers([path]) == list(range(70, 121))
    assert numbers([path], INFO_KEY) == [0]
    assert read_metadata(path)[CLIP_RECORD] == {str(START_NS + 10**10): "snapshot"}
    assert verify_recording(path) == []
    assert run.clips.under_way is None
    assert run.problems == [None]


def test_an_info_that_came_meanwhile_stands_once_and_at_its_place(tmp_path: Path) -> None:
    run = Run(tmp_path)
    run.frames(10)
    run.trigger()
    run.frames(30)
    (path,) = clips(tmp_path)
    assert [message.topic for message in read_recording(path)][:2] == [INFO, RGBD]
    assert numbers([path], INFO_KEY) == [0]
    assert numbers([path]) == list(range(1, 31))


def test_events_that_overlap_make_one_clip_longer_and_later_ones_another(tmp_path: Path) -> None:
    run = Run(tmp_path)
    run.frames(50)
    first = run.trigger("event fall")
    run.frames(15)
    assert run.trigger("event call") == first
    run.frames(30)
    assert run.trigger("event rise") != first
    run.frames(30)
    one, other = clips(tmp_path)
    assert numbers([one]) == list(range(20, 86))
    assert list(read_metadata(one)[CLIP_RECORD].values()) == ["event fall", "event call"]
    assert numbers([other]) == list(range(65, 116))


def test_what_has_to_go_is_written_first_so_that_the_bound_holds_and_the_clip_is_complete(
    tmp_path: Path,
) -> None:
    run = Run(tmp_path, size=40_000)
    run.frames(100)
    held = run.clips.ring.end - run.clips.ring.first
    assert 15 < held < 25
    run.trigger()
    run.frames(60, written=False)
    assert run.clips.ring.bytes <= 40_000
    run.clips.step(run.now, all_came=True)
    (path,) = clips(tmp_path)
    assert numbers([path]) == list(range(101 - held, 121))


def test_a_clip_whose_disk_fails_is_written_of_what_is_held_when_it_is_back(
    tmp_path: Path,
) -> None:
    folder = tmp_path / "clips"
    folder.write_text("in the way")
    run = Run(folder)
    run.frames(50)
    run.trigger()
    run.frames(5)
    assert "cannot create" in str(run.problems[0])
    folder.unlink()
    run.frames(50)
    (path,) = clips(folder)
    assert numbers([path])[-1] == 70
    assert len(numbers([path])) >= 30
    assert run.problems[-1] is None


def test_the_end_makes_a_clip_whole_before_its_time(tmp_path: Path) -> None:
    run = Run(tmp_path)
    run.frames(50)
    run.trigger()
    run.frames(5, written=False)
    run.clips.close(run.now)
    (path,) = clips(tmp_path)
    assert numbers([path]) == list(range(20, 56))


@pytest.mark.long
def test_an_event_and_a_word_make_complete_clips_while_recording_and_paused(
    rig: RunningRig, wire: Wire
) -> None:
    recorder = start_recorder(
        rig, 'ring_seconds = 2\nring_bytes = "64MiB"\nafter_seconds = 1\nring_events = ["fall*"]'
    )
    rig.publisher("--frame-bytes", "50000")
    eventually("90 frames on the disk", lambda: frames_in(rig) >= 90)
    events = wire.publisher(EVENT, "fallen")
    eventually("the recorder listens", events.wanted)
    events.put(Event(sequence=0, time_ns=time.time_ns(), kind="fallen"))
    (clip,) = eventually("a clip", lambda: recordings(rig, "clips/*.mcap"))
    frames = numbers([clip])
    assert frames == list(range(frames[0], frames[-1] + 1))
    assert 75 <= len(frames) <= 95
    assert numbers([clip], INFO_KEY) == [0]
    assert numbers([clip], EVENT.key(Site(), "fallen")) == [0]
    assert list(read_metadata(clip)[CLIP_RECORD].values()) == ["event fallen"]
    assert verify_recording(clip) == []
    assert rig.done("recorder", "pause", "--config", rig.config).popen.returncode == 0
    time.sleep(2.0)
    asked = rig.done("recorder", "snapshot", "--config", rig.config)
    assert "; makes the clip rig_2" in asked.stdout
    _, other = eventually("another", lambda: (r := recordings(rig, "clips/*.mcap"))[1:] and r)
    later = numbers([other])
    assert later == list(range(later[0], later[-1] + 1))
    assert len(later) >= 75
    assert numbers([other], INFO_KEY) == [0]
    assert recorder.stop() == 0
    recorded = numbers(recordings(rig))
    assert recorded == list(range(recorded[-1] + 1))
    assert recorded[-1] < later[-1]


@pytest.mark.long
def test_without_a_ring_a_snapshot_says_what_is_missing(rig: RunningRig) -> None:
    start_recorder(rig)
    asked = rig.done("recorder", "snapshot", "--config", rig.config)
    assert asked.popen.returncode == 1
    assert "set ring_seconds in its settings" in asked.stdout

"""What is deleted so that a folder does not grow for ever, and what never is."""

import os
from datetime import UTC, datetime
from pathlib import Path

import pytest
from inhand_recorder.provenance import RECORDER_RECORD, Provenance
from inhand_recorder.quotas import Quotas
from inhand_recorder.recording_file import RecordingFile
from inhand_recorder.retention import Retention
from inhand_recorder.settings import RecorderSettings
from inhand_runtime.settings import load_settings
from recordings import START_NS

NOW_NS = START_NS + 30 * 86_400 * 10**9
SIZE = 1 << 20


def recording(folder: Path, day: int, *, ours: bool = True) -> Path:
    """A whole file of a day of November 2023, of 1 MiB."""
    folder.mkdir(exist_ok=True)
    path = folder / f"rig_202311{day:02}T120000Z.mcap"
    file = RecordingFile(path, 0.0)
    provenance = Provenance(load_settings(None, "recorder", RecorderSettings))
    file.note_all(provenance.records() if ours else {"session": {"participant": "p01"}})
    file.note("padding", {"": "x" * (SIZE - 2000)})
    file.finish({})
    written = datetime(2023, 11, day, 13, tzinfo=UTC).timestamp()
    os.utime(path, (written, written))
    return path


class Kept:
    """A folder with a retention."""

    def __init__(self, folder: Path, quotas: Quotas, free: int | None = None) -> None:
        self.deleted: list[str] = []
        self.seconds = 0.0
        self.retention = Retention(
            folder,
            quotas,
            lambda path, *_: self.deleted.append(path.name),
            clock=lambda: self.seconds,
        )

    def tidy(self, hours: float = 0.0, ahead_s: float = 0.0) -> list[str]:
        """What is deleted once these hours have passed, with the wall clock set ahead."""
        self.seconds += 3600.0 * hours
        self.retention.tidy(NOW_NS + int((self.seconds + ahead_s) * 1e9))
        return self.deleted


def test_the_oldest_go_while_all_take_too_much(tmp_path: Path) -> None:
    paths = [recording(tmp_path, day) for day in (3, 1, 2, 4)]
    (tmp_path / "rig_20231105T120000Z.mcap.part").write_bytes(bytes(SIZE))
    kept = Kept(tmp_path, Quotas(keep_bytes=3 * SIZE + 5000))
    assert kept.tidy() == [paths[1].name, paths[2].name]
    assert kept.tidy() == [paths[1].name, paths[2].name]
    assert kept.retention.deleted == 2
    assert kept.retention.problem is None
    assert 2 * SIZE < kept.retention.folder_bytes <= 3 * SIZE + 5000


def test_what_is_older_than_so_many_days_goes(tmp_path: Path) -> None:
    paths = [recording(tmp_path, day) for day in (1, 10, 20)]
    touched = recording(tmp_path, 2)
    os.utime(touched)
    kept = Kept(tmp_path, Quotas(keep_days=30.0))
    assert kept.tidy() == []
    assert kept.tidy(hours=1.0) == [paths[0].name, paths[1].name]
    assert paths[2].exists()
    assert touched.exists()


def test_a_clock_that_is_set_far_ahead_costs_nothing_for_an_hour(tmp_path: Path) -> None:
    path = recording(tmp_path, 20)
    kept, year_s = Kept(tmp_path, Quotas(keep_days=30.0)), 365 * 86_400.0
    kept.tidy()
    assert kept.tidy(hours=2.0, ahead_s=year_s) == []
    assert kept.tidy(hours=0.9, ahead_s=year_s) == []
    assert kept.tidy(hours=0.1) == []  # it is set back
    assert kept.tidy(hours=2.0) == []
    assert path.exists()


def test_only_whole_files_of_a_recorder_in_the_folder_itself_are_deleted(tmp_path: Path) -> None:
    elsewhere = recording(tmp_path / "elsewhere", 1)
    clip = recording(tmp_path / "clips", 1)
    take = recording(tmp_path, 1, ours=False)
    named = recording(tmp_path, 2).rename(tmp_path / "precious.mcap")
    part = recording(tmp_path, 3)
    part = part.rename(part.with_name(part.name + ".part"))
    link = tmp_path / "rig_20231104T120000Z.mcap"
    link.symlink_to(elsewhere)
    foreign = tmp_path / "rig_20231105T120000Z.mcap"
    foreign.write_bytes(RECORDER_RECORD.encode() * 1000)
    ours = recording(tmp_path, 6)
    kept = Kept(tmp_path, Quotas(keep_bytes=1, keep_days=0.1))
    assert kept.tidy() == [ours.name]
    assert all(path.exists() for path in (elsewhere, clip, take, named, part, link, foreign))
    assert "recover or move away" in str(kept.retention.problem)


def test_what_no_quota_deletes_is_counted_and_said_once(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    recording(tmp_path, 1, ours=False)  # as release 0.1.0 wrote them
    recording(tmp_path, 2).rename(tmp_path / "precious.mcap")
    recording(tmp_path, 3)
    recording(tmp_path / "clips", 4)
    kept = Kept(tmp_path, Quotas(keep_bytes=100 * SIZE))
    for _ in range(3):
        assert kept.tidy() == []
    foreign, clips = kept.retention.foreign, kept.retention.clips
    assert (foreign.files, clips.files) == (2, 1)
    assert abs(foreign.bytes - 2 * SIZE) < 5000
    assert abs(kept.retention.folder_bytes - 3 * SIZE) < 5000
    (line,) = [one.getMessage() for one in caplog.records]
    assert line.startswith(f"no quota deletes 2 recordings in {tmp_path} (2.1 MB)")
    assert kept.retention.problem is None
    without = Kept(tmp_path, Quotas())
    without.tidy()
    assert len(caplog.records) == 1


def test_clips_that_alone_take_more_than_is_to_be_kept_are_a_trouble(tmp_path: Path) -> None:
    paths = [recording(tmp_path / "clips", day) for day in (1, 2, 3)]
    ours = recording(tmp_path, 4)
    kept = Kept(tmp_path, Quotas(keep_bytes=2 * SIZE))
    assert kept.tidy() == []
    assert "clips take more than 2.1 MB (keep_bytes), and no quota deletes" in str(
        kept.retention.problem
    ).replace(f"in {tmp_path / 'clips'} ", "")
    paths[0].unlink()
    paths[1].unlink()
    kept.tidy()
    assert kept.retention.problem is None
    assert ours.exists()


def test_a_nearly_full_disk_costs_the_oldest_or_stops_as_is_chosen(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    paths = [recording(tmp_path, day) for day in (1, 2, 3)]
    free = property(lambda self: 10 * SIZE + SIZE * self.deleted)
    monkeypatch.setattr(Retention, "free_bytes", free)
    stops = Kept(tmp_path, Quotas(free_bytes=11 * SIZE))
    assert stops.tidy() == []
    assert "(free_bytes): make room" in str(stops.retention.too_full(stopped=False))
    assert not stops.retention.make_room()
    goes_on = Kept(tmp_path, Quotas(free_bytes=11 * SIZE, when_full="delete-oldest"))
    assert goes_on.tidy() == [paths[0].name]
    assert goes_on.retention.too_full(stopped=False) is None
    assert goes_on.retention.make_room()
    assert goes_on.deleted == [paths[0].name, paths[1].name]
    barely = Kept(tmp_path, Quotas(free_bytes=10 * SIZE))
    assert barely.retention.too_full(stopped=False) is None
    assert barely.retention.too_full(stopped=True) is not None


def test_files_are_small_enough_that_some_can_be_deleted_while_one_grows(tmp_path: Path) -> None:
    assert Kept(tmp_path, Quotas()).retention.file_limit() == 0
    assert Kept(tmp_path, Quotas(keep_bytes=100 * SIZE)).retention.file_limit() == 25 * SIZE
    kept = Kept(tmp_path, Quotas(free_bytes=1 << 60, when_full="delete-oldest"))
    assert kept.retention.file_limit() == 1 << 20

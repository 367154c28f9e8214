"""What holds for the import of any format."""

from collections.abc import Callable
from pathlib import Path

import pytest
from bop_data import save_bop
from foreign_data import messages_of, only_entry, save_archive, save_trial, save_video
from foreign_skeletons import (
    azure_kinect_values,
    coco_values,
    ntu_text,
    save_json,
    save_npz,
    save_text,
    zed_values,
)
from inhand_lab.datasets.dataset import load_dataset
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.importers.motion import import_motion
from inhand_runtime.errors import InhandError
from inhand_schemas.messages import Skeletons

from inhand.__main__ import main

SOURCES: dict[str, Callable[[Path], Path]] = {
    "motion": lambda folder: save_archive(folder / "walk.npz"),
    "utd-mhad": lambda folder: save_trial(folder, 2, 2),
    "ycb-video": lambda folder: save_video(folder / "in"),
    "bop": lambda folder: save_bop(folder / "in"),
    "azure-kinect": lambda folder: save_json(folder / "walk.json", azure_kinect_values()),
    "zed": lambda folder: save_json(folder / "walk.json", zed_values()),
    "ntu": lambda folder: save_text(folder / "walk.skeleton", ntu_text()),
    "coco": lambda folder: save_npz(folder / "walk.npz", coco_values()),
}
CONVENTIONS = {
    "utd-mhad": "kinect_v1",
    "azure-kinect": "azure_kinect",
    "zed": "zed",
    "ntu": "kinect_v2",
    "coco": "coco",
}
"""Whose joints a format holds; the others do not say."""
WITH_PEOPLE = ("motion", "utd-mhad", "azure-kinect", "zed", "ntu", "coco")
RECORDED = {"utd-mhad": "a15_s3_t2"}
"""Names of recordings that are not called walk."""
TIMED = ("azure-kinect", "zed", "coco")
"""Formats whose frames tell their times, so that the dataset need not say their rate."""


@pytest.mark.parametrize("name", SOURCES)
class TestEveryImport:
    def test_a_source_that_is_missing_is_told_in_one_line(
        self, name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        assert main(["import", name, str(tmp_path / "missing"), str(tmp_path / "out")]) == 1
        (line,) = capsys.readouterr().err.splitlines()
        assert line.startswith("inhand import: ")
        assert "missing" in line

    def test_an_empty_folder_is_told_in_one_line(
        self, name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        assert main(["import", name, str(tmp_path), str(tmp_path / "out")]) == 1
        assert "holds no" in capsys.readouterr().err

    def test_a_folder_with_a_dataset_is_left_alone(
        self, name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        source = SOURCES[name](tmp_path)
        DatasetWriter(tmp_path / "out").finish({})
        before = (tmp_path / "out" / "dataset.toml").read_bytes()
        assert main(["import", name, str(source), str(tmp_path / "out")]) == 1
        assert "holds a dataset already" in capsys.readouterr().err
        assert (tmp_path / "out" / "dataset.toml").read_bytes() == before

    def test_the_verb_makes_a_dataset_that_can_be_loaded(self, name: str, tmp_path: Path) -> None:
        source = SOURCES[name](tmp_path)
        out = tmp_path / "out"
        assert main(["import", name, str(source), str(out), "--frame-rate", "15"]) == 0
        assert only_entry(load_dataset(out)).frame_rate == (None if name in TIMED else 15.0)
        named = [m for m in messages_of(load_dataset(out)) if isinstance(m, Skeletons)]
        assert {one.convention for one in named} <= {CONVENTIONS.get(name)}


@pytest.mark.parametrize("name", WITH_PEOPLE)
def test_a_bad_file_among_good_ones_is_named_with_its_reason_counted_and_passed_over(
    name: str, tmp_path: Path, caplog: pytest.LogCaptureFixture, capsys: pytest.CaptureFixture[str]
) -> None:
    folder, out = tmp_path / "in", tmp_path / "out"
    folder.mkdir()
    source = SOURCES[name](folder)
    bad = folder / source.name.replace("walk", "broken").replace("a15_s3", "a15_s4")
    bad.write_bytes(source.read_bytes()[:-40])
    assert main(["import", name, str(folder), str(out)]) == 0
    reason, count = (message for message in caplog.messages if "left out" in message)
    assert str(bad) in reason
    assert count.startswith("left out: 1 of 2 files")
    assert "1 recording" in capsys.readouterr().out
    recorded = RECORDED.get(name, "walk") + ".mcap"
    assert only_entry(load_dataset(out)).file == f"recordings/{recorded}"
    assert [one.name for one in (out / "recordings").iterdir()] == [recorded]


def test_where_every_file_is_bad_one_line_says_so_and_nothing_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("a", "b", "c"):
        (tmp_path / f"{name}.skeleton").write_text("nonsense")
    assert main(["import", "ntu", str(tmp_path), str(tmp_path / "out")]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert "so it is with 2 other files" in line
    assert not (tmp_path / "out").exists()


def test_two_sources_of_one_name_are_refused(tmp_path: Path) -> None:
    (tmp_path / "other").mkdir()
    sources = [save_archive(tmp_path / "walk.npz"), save_archive(tmp_path / "other" / "walk.npz")]
    with pytest.raises(InhandError, match="would be the same recording"):
        import_motion(sources, tmp_path / "out")

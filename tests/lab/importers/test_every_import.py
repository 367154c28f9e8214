"""What holds for the import of any format."""

from pathlib import Path

import pytest
from bop_data import save_bop
from foreign_data import only_entry, save_archive, save_trial, save_video
from inhand_lab.datasets.dataset import load_dataset
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.importers.motion import import_motion
from inhand_runtime.errors import InhandError

from inhand.__main__ import main


@pytest.mark.parametrize("name", ["motion", "utd-mhad", "ycb-video", "bop"])
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
        source = {
            "motion": lambda: save_archive(tmp_path / "walk.npz"),
            "utd-mhad": lambda: save_trial(tmp_path, 1, None),
            "ycb-video": lambda: save_video(tmp_path / "in"),
            "bop": lambda: save_bop(tmp_path / "in"),
        }[name]()
        DatasetWriter(tmp_path / "out").finish({})
        before = (tmp_path / "out" / "dataset.toml").read_bytes()
        assert main(["import", name, str(source), str(tmp_path / "out")]) == 1
        assert "holds a dataset already" in capsys.readouterr().err
        assert (tmp_path / "out" / "dataset.toml").read_bytes() == before

    def test_the_verb_makes_a_dataset_that_can_be_loaded(self, name: str, tmp_path: Path) -> None:
        source = {
            "motion": lambda: save_archive(tmp_path / "walk.npz"),
            "utd-mhad": lambda: save_trial(tmp_path, 2, 2),
            "ycb-video": lambda: save_video(tmp_path / "in"),
            "bop": lambda: save_bop(tmp_path / "in"),
        }[name]()
        out = tmp_path / "out"
        assert main(["import", name, str(source), str(out), "--frame-rate", "15"]) == 0
        assert only_entry(load_dataset(out)).frame_rate == 15.0


def test_two_sources_of_one_name_are_refused(tmp_path: Path) -> None:
    (tmp_path / "other").mkdir()
    sources = [save_archive(tmp_path / "walk.npz"), save_archive(tmp_path / "other" / "walk.npz")]
    with pytest.raises(InhandError, match="would be the same recording"):
        import_motion(sources, tmp_path / "out")

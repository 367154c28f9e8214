"""One file of arrays and a description, whatever is kept in it."""

from pathlib import Path

import numpy as np
import pytest
from inhand_tracker.model.archive import ArchiveKind, Arrays, read_archive, write_archive
from inhand_tracker.model.model import ModelError

NOUNS = ("a toy of version", "version")
KIND = ArchiveKind("toy", "inhand-toy", 2, "Inhand toy", NOUNS, "carve one", "carve it again")
ARRAYS: Arrays = {"wheels": np.arange(4), "edges": np.eye(2, dtype=np.float32)}


def as_it_is(description: dict[str, object], arrays: Arrays) -> tuple[dict[str, object], Arrays]:
    return description, arrays


@pytest.fixture
def path(tmp_path: Path) -> Path:
    write_archive(KIND, tmp_path / "toy", {"colour": "red"}, ARRAYS)
    return tmp_path / "toy"


def message(path: Path, kind: ArchiveKind = KIND) -> str:
    with pytest.raises(ModelError) as refused:
        read_archive(kind, path, as_it_is)
    return str(refused.value)


def test_description_and_arrays_come_back(path: Path) -> None:
    description, arrays = read_archive(KIND, path, as_it_is)
    assert description == {"format": "inhand-toy", "version": 2, "colour": "red"}
    for name, array in ARRAYS.items():
        np.testing.assert_array_equal(arrays[name], array)
        assert arrays[name].dtype == array.dtype


def test_the_same_content_gives_the_same_bytes_of_description(path: Path) -> None:
    with np.load(path) as archive:
        assert str(archive["toy"]) == '{"format": "inhand-toy", "version": 2, "colour": "red"}'


def test_an_older_and_a_newer_file_are_refused_with_both_versions(path: Path) -> None:
    newer = ArchiveKind(**{**vars(KIND), "version": 3})
    assert message(path, newer) == (
        f"{path} is a toy of version 2, and this release reads version 3: "
        "update Inhand, or train again"
    )


def test_a_file_of_another_kind_is_refused(path: Path) -> None:
    for other in ({"entry": "doll"}, {"format": "inhand-doll"}):
        kind = ArchiveKind(**{**vars(KIND), **other})
        assert message(path, kind) == f"{path} is no Inhand toy: carve one"


def test_a_file_that_was_cut_short_is_damaged(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:100])
    assert message(path).startswith(f"{path} is damaged (")
    assert message(path).endswith("): copy it again, or carve it again")


def test_a_file_of_which_nothing_can_be_made_is_damaged(path: Path) -> None:
    with pytest.raises(ModelError, match=r"is damaged \('sails'\)"):
        read_archive(KIND, path, lambda description, arrays: arrays["sails"])


def test_a_missing_file_cannot_be_read(tmp_path: Path) -> None:
    assert (
        message(tmp_path / "none") == f"cannot read {tmp_path / 'none'}: No such file or directory"
    )

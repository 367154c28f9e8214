"""Model files: whole ones come back equal, all others are refused with ModelError."""

import errno
import io
import json
import os
import pickle
import zipfile
from dataclasses import fields, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inhand_tracker.mapping.learning import learn
from inhand_tracker.mapping.mapping import Mapping
from inhand_tracker.model.model import Model, ModelError
from inhand_tracker.model.model_file import load_model, save_model
from inhand_tracker.model.taught import TaughtRecordings
from inhand_tracker.shape.contours import find_contours
from inhand_tracker.shape.viewpoints import Viewpoints
from inhand_tracker.sight.appearance import Appearance
from people import sequence, wedge


@lru_cache(maxsize=1)
def small_model() -> Model:
    shape = wedge()
    sequences = [sequence(f"p{i}", 4, seed=i) for i in range(2)]
    mapping = learn(sequences, shape.mirror_normal)
    boundaries, surfaces = np.random.default_rng(0).normal(size=(2, 3, 50, 3))
    viewpoints, taught = Viewpoints(np.eye(3), boundaries, surfaces), TaughtRecordings.of(sequences)
    return Model("wave", shape, mapping, viewpoints, taught=taught)


def test_recordings_that_taught_come_back_nearly_as_they_were() -> None:
    some = [
        replace(sequence("p", 5), left_handed=True, recording="long.mcap", convention="kinect_v1"),
        replace(sequence("q", 3, seed=1), frame_rate=15.0),
    ]
    for one, other in zip(some, TaughtRecordings.of(some).sequences(), strict=True):
        np.testing.assert_allclose(other.joints, one.joints, atol=1e-6)
        np.testing.assert_allclose(other.rotations, one.rotations, atol=1e-6)
        for name in ("participant", "left_handed", "frame_rate", "recording", "convention"):
            assert getattr(other, name) == getattr(one, name)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "mug.model"
    save_model(small_model(), path)
    return path


def equal(first: Any, second: Any) -> bool:
    if isinstance(first, np.ndarray):
        return first.dtype == second.dtype and np.array_equal(first, second)
    if hasattr(first, "__dataclass_fields__"):
        return type(first) is type(second) and all(
            equal(getattr(first, f.name), getattr(second, f.name)) for f in fields(first)
        )
    return bool(first == second)


def test_a_model_comes_back_as_it_was(path: Path) -> None:
    assert equal(load_model(path), small_model())
    assert not equal(replace(small_model(), interaction="other"), small_model())


def test_a_model_keeps_its_convention_and_one_of_before_there_were_any_says_none(
    path: Path,
) -> None:
    model = small_model()
    named = replace(model, mapping=replace(model.mapping, convention="kinect_v1"))
    save_model(named, path)
    assert load_model(path).mapping.convention == "kinect_v1"
    without_entry(path, "convention")
    assert load_model(path).mapping.convention is None


def test_what_is_seen_of_an_object_and_how_it_looks_come_back_too(tmp_path: Path) -> None:
    shape = small_model().shape
    contours = find_contours(shape, np.eye(3))
    colours = np.full((2, 4096), 1.0 / 4096.0, np.float32)
    full = replace(
        small_model(),
        viewpoints=replace(small_model().viewpoints, contours=contours),
        appearance=Appearance(*colours, 0.8, 0.1, 0.02, 0.05),
    )
    save_model(full, tmp_path / "full.model")
    loaded = load_model(tmp_path / "full.model")
    assert equal(loaded, full)
    assert loaded.viewpoints.contours is not None
    assert loaded.viewpoints.contours.points.dtype == np.float32


def test_a_model_of_a_release_that_learned_no_light_loads_and_knows_none(tmp_path: Path) -> None:
    colours = np.full((2, 4096), 1.0 / 4096.0, np.float32)
    new = replace(small_model(), appearance=Appearance(*colours, 0.8, 0.1, 0.02, 0.05))
    save_model(new, tmp_path / "new.model")
    with np.load(tmp_path / "new.model") as archive:
        older = {name: archive[name] for name in archive if "tint" not in name}
    with (tmp_path / "older.model").open("wb") as file:
        np.savez(file, **older)
    loaded, again = load_model(tmp_path / "older.model"), load_model(tmp_path / "new.model")
    assert loaded.appearance is not None
    assert again.appearance is not None
    assert np.isnan([loaded.appearance.tint, loaded.appearance.tint_range]).all()
    assert (again.appearance.tint, again.appearance.tint_range) == (0.02, 0.05)


def test_a_model_of_a_release_without_surfaces_still_loads(tmp_path: Path) -> None:
    old = replace(small_model(), viewpoints=replace(small_model().viewpoints, surfaces=None))
    save_model(old, tmp_path / "old.model")
    with np.load(tmp_path / "old.model") as archive:
        assert "viewpoints.surfaces" not in archive
    assert equal(load_model(tmp_path / "old.model"), old)


def test_the_file_is_written_under_exactly_its_name_in_a_folder_that_is_made(
    tmp_path: Path,
) -> None:
    path = tmp_path / "models" / "new" / "mug.model"
    save_model(small_model(), path)
    assert [child.name for child in path.parent.iterdir()] == ["mug.model"]


def test_numpy_alone_can_read_it_without_pickle(path: Path) -> None:
    with np.load(path, allow_pickle=False) as archive:
        description = json.loads(str(archive["model"]))
        np.testing.assert_array_equal(
            archive["mapping.body_poses"], small_model().mapping.body_poses
        )
    assert description["format"] == "inhand-model"
    assert description["version"] == 1


def test_a_new_model_replaces_the_old_one(path: Path) -> None:
    save_model(replace(small_model(), interaction="other"), path)
    assert load_model(path).interaction == "other"


def test_a_model_stays_whole_when_another_cannot_be_written(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full_disk(file: io.BufferedWriter, **_: Any) -> None:
        file.write(b"PK")
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(np, "savez", full_disk)
    with pytest.raises(ModelError, match=r"cannot write .*mug\.model: No space left on device"):
        save_model(replace(small_model(), interaction="other"), path)
    assert equal(load_model(path), small_model())


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_an_unwritable_folder_is_told(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    with pytest.raises(ModelError, match="cannot write"):
        save_model(small_model(), tmp_path / "mug.model")


def test_a_path_that_is_a_folder_is_told(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="cannot write"):
        save_model(small_model(), tmp_path)
    with pytest.raises(ModelError, match="cannot read"):
        load_model(tmp_path)


def test_a_file_in_the_place_of_the_folder_is_told(path: Path) -> None:
    with pytest.raises(ModelError, match="cannot write"):
        save_model(small_model(), path / "mug.model")


def test_a_missing_file_is_told(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"cannot read .*nothing\.model"):
        load_model(tmp_path / "nothing.model")


def refused(path: Path) -> str:
    """The one line with which a file is refused."""
    with pytest.raises(ModelError) as caught:
        load_model(path)
    message = str(caught.value)
    assert path.name in message
    assert "\n" not in message
    return message


def test_a_file_cut_short_is_refused_at_every_length(path: Path) -> None:
    whole = path.read_bytes()
    for length in [*range(0, 100, 7), *range(100, len(whole), 997), len(whole) - 1]:
        path.write_bytes(whole[:length])
        message = refused(path)
        assert "inhand train" in message
        if length > 4:
            assert "damaged" in message


def interesting_offsets(path: Path) -> list[int]:
    """Places in all headers of the archive, and some in the data."""
    with zipfile.ZipFile(path) as archive:
        starts = [entry.header_offset for entry in archive.infolist()]
        directory = archive.start_dir
    size = path.stat().st_size
    headers = [start + i for start in starts[::4] for i in range(60)]
    return [
        *headers,
        *range(directory, directory + 200),
        *range(size - 22, size),
        *range(0, size, 701),
    ]


@pytest.mark.parametrize("mask", [0x01, 0x08, 0x80, 0xFF])
def test_a_flipped_byte_is_refused_or_does_no_harm(path: Path, mask: int) -> None:
    whole = path.read_bytes()
    outcomes = {"refused": 0, "harmless": 0}
    for offset in interesting_offsets(path):
        damaged = bytearray(whole)
        damaged[offset] ^= mask
        path.write_bytes(damaged)
        try:
            loaded = load_model(path)
        except ModelError:
            outcomes["refused"] += 1
        else:
            assert equal(loaded, small_model()), offset
            outcomes["harmless"] += 1
    assert min(outcomes.values()) > 20


def test_changed_data_is_refused(path: Path) -> None:
    """Each array has its checksum: no damage within one can pass."""
    with zipfile.ZipFile(path) as archive:
        entries = archive.infolist()
    whole = path.read_bytes()
    for entry in entries:
        damaged = bytearray(whole)
        local_name = len(entry.filename.encode())
        damaged[entry.header_offset + 30 + local_name + 20 + entry.compress_size // 2] ^= 0x10
        path.write_bytes(damaged)
        assert "damaged" in refused(path)


@pytest.mark.parametrize(
    "content",
    [b"", b"P", b"PK", b"hello", b"\x89PNG\r\n\x1a\n" + bytes(100), bytes(1000), b"\xff" * 3000],
)
def test_foreign_files_are_refused(path: Path, content: bytes) -> None:
    path.write_bytes(content)
    assert "make" in refused(path)


def test_a_foreign_zip_is_no_model(path: Path) -> None:
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("word/document.xml", "<xml/>")
    assert "is no Inhand model" in refused(path)


def test_a_zip_with_a_text_named_like_ours_is_refused(path: Path) -> None:
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("model", "hello")
    refused(path)
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("model.npy", "hello")
    refused(path)


def test_a_single_array_is_no_model(path: Path) -> None:
    buffer = io.BytesIO()
    np.save(buffer, np.arange(3))
    path.write_bytes(buffer.getvalue())
    assert "is no Inhand model" in refused(path)


class Trap:
    """Leaves a file behind when it is unpickled."""

    def __init__(self, trace: Path) -> None:
        self._trace = trace

    def __reduce__(self) -> tuple[Any, ...]:
        return Path.touch, (self._trace,)


def arrays_of(path: Path) -> dict[str, np.ndarray]:
    with np.load(path) as archive:
        return {name: archive[name] for name in archive.files}


def rewrite(path: Path, arrays: dict[str, Any]) -> None:
    with path.open("wb") as file:
        np.savez(file, **arrays)


@pytest.mark.parametrize("name", ["model", "mapping.starts", "shape.faces", "more"])
def test_pickles_inside_are_refused_and_never_run(path: Path, tmp_path: Path, name: str) -> None:
    trace = tmp_path / "executed"
    arrays = arrays_of(path)
    arrays[name] = np.array([Trap(trace)], dtype=object)
    rewrite(path, arrays)
    refused(path)
    assert not trace.exists()


def test_a_bare_pickle_is_refused_and_never_run(path: Path, tmp_path: Path) -> None:
    trace = tmp_path / "executed"
    path.write_bytes(pickle.dumps(Trap(trace)))
    refused(path)
    assert not trace.exists()


def described(path: Path, **changes: Any) -> None:
    arrays = arrays_of(path)
    description = json.loads(str(arrays["model"])) | changes
    rewrite(path, arrays | {"model": np.array(json.dumps(description))})


def without_entry(path: Path, key: str) -> None:
    arrays = arrays_of(path)
    description = json.loads(str(arrays["model"]))
    del description[key]
    rewrite(path, arrays | {"model": np.array(json.dumps(description))})


@pytest.mark.parametrize("version", [0, 2, 99, "2", None])
def test_another_version_is_refused_with_the_mend(path: Path, version: Any) -> None:
    described(path, version=version)
    message = refused(path)
    assert f"version {version}" in message
    assert "update Inhand, or train again" in message


def test_another_format_is_no_model(path: Path) -> None:
    described(path, format="something")
    assert "is no Inhand model" in refused(path)


@pytest.mark.parametrize(
    "changes",
    [
        {"participants": None},
        {"participants": 3},
        {"convention": 3},
        {"symmetries": None},
        {"symmetries": [[1, 2]]},
        {"symmetries": [1]},
    ],
)
def test_a_description_of_wrong_types_is_refused(path: Path, changes: dict[str, Any]) -> None:
    described(path, **changes)
    assert "damaged" in refused(path)


@pytest.mark.parametrize("text", ["[]", "3", "null", '"x"', "{", "", "[" * 100_000])
def test_a_description_that_is_none_is_refused(path: Path, text: str) -> None:
    rewrite(path, arrays_of(path) | {"model": np.array(text)})
    refused(path)


@pytest.mark.parametrize(
    "name",
    ["shape.faces", "viewpoints.boundaries", *(f"mapping.{f.name}" for f in fields(Mapping)[1:-2])],
)
def test_a_model_that_lacks_an_array_is_refused(path: Path, name: str) -> None:
    arrays = arrays_of(path)
    del arrays[name]
    rewrite(path, arrays)
    assert "damaged" in refused(path)


@pytest.mark.parametrize("key", ["version", "object", "interaction", "participants", "symmetries"])
def test_a_description_that_lacks_an_entry_is_refused(path: Path, key: str) -> None:
    without_entry(path, key)
    assert "damaged" in refused(path)

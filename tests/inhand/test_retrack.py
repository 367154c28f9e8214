"""Recordings are tracked again, with the new poses beside all that they held."""

import json
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from inhand_recorder.losses import LOSSES_RECORD, LossCounter, format_losses
from inhand_recorder.verification import verify_recording
from inhand_runtime.pixels import encode_colour, encode_depth
from inhand_runtime.recording import RecordingWriter, read_metadata, read_recording
from inhand_schemas.keys import Site
from inhand_schemas.messages import (
    CameraInfo,
    ColourImage,
    Message,
    ObjectPose,
    Person,
    RgbdFrame,
    Skeletons,
)
from inhand_schemas.topics import INFO, POSE, RGBD, SKELETONS, AnyTopic
from inhand_tracker.model.model_file import save_model
from people import FRAME_NS, unseen_wave, wave_model

from inhand.__main__ import main

FRAMES = 12
CAMERA = CameraInfo(
    sequence=0, time_ns=0, width=160, height=120, fx=130, fy=130, cx=80, cy=60, frame_rate=30
)


def recorded(
    path: Path,
    *,
    camera: str = "front",
    seed: int = 0,
    skeletons: bool = True,
    person: int = 7,
) -> Path:
    """Somebody who waves before a wall of noise, with poses that a tracker published then; one
    picture is damaged, one was lost, and one message of skeletons could not be read."""
    random = np.random.default_rng(seed)
    depth = encode_depth(np.full((120, 160), 3000, np.uint16))
    with RecordingWriter(path) as writer:
        counter = LossCounter()

        def write(topic: AnyTopic, name: str, message: Message) -> None:
            counter.count(topic.key(Site(), name), message.sequence)
            writer.write(
                topic.key(Site(), name),
                topic.encode(message),  # type: ignore[arg-type]
                received_ns=message.time_ns + 5_000_000,
                captured_ns=message.time_ns,
                sequence=message.sequence,
            )

        write(INFO, camera, CAMERA)
        for number, joints in enumerate(unseen_wave(FRAMES) + 0.01 * seed):
            stamp = {"sequence": 10 + number, "time_ns": 10**18 + number * FRAME_NS}
            waving = Person(
                id=person,
                joints=tuple(map(tuple, joints.tolist())),
                states=("tracked",) * 20,
                confidences=(1.0,) * 20,
            )
            if skeletons:
                write(SKELETONS, camera, Skeletons(**stamp, people=(waving,)))
            colour = encode_colour(random.integers(0, 255, (120, 160, 3), np.uint8))
            if number == 3:
                colour = ColourImage("jpeg", 160, 120, b"no picture")
            if number != 5:
                write(RGBD, camera, RgbdFrame(**stamp, colour=colour, depth=depth))
            lost = {"object": "wedge", "camera": camera, "state": "lost", "confidence": 0.5}
            write(POSE, "wedge", ObjectPose(**stamp, **lost))
            if number == 6:
                writer.write_apart(
                    SKELETONS.key(Site(), camera), b"\xc1", received_ns=stamp["time_ns"]
                )
        writer.add_metadata(LOSSES_RECORD, format_losses(counter.losses()))
    return path


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("models") / "wedge.model"
    save_model(wave_model(), path)
    return path


def retrack(model: Path, *files: Path, folder: Path, more: tuple[str, ...] = ()) -> int:
    names = [str(file) for file in files]
    arguments = ["recording", "retrack", *names, "--model", str(model), "-o", str(folder), *more]
    return main([*arguments, *(() if "--jobs" in more else ("--jobs", "1"))])


def poses(path: Path, name: str) -> list[Message]:
    return [m.message() for m in read_recording(path, streams=("pose",)) if m.name == name]


def test_new_poses_stand_beside_all_that_was_recorded(tmp_path: Path, model: Path) -> None:
    path, folder = recorded(tmp_path / "walk.mcap"), tmp_path / "again"
    result = tmp_path / "result.json"
    assert retrack(model, path, folder=folder, more=("--json", str(result))) == 0
    output = folder / "walk.mcap"
    before = [(m.key, m.payload, m.received_ns, m.captured_ns) for m in read_recording(path)]
    after = list(read_recording(output))
    key = POSE.key(Site(), "wedge_retrack")
    kept = [(m.key, m.payload, m.received_ns, m.captured_ns) for m in after if m.key != key]
    assert kept == before
    apart = [m for m in read_recording(output, apart=True) if m.apart]
    assert [(m.name, m.payload) for m in apart] == [("front", b"\xc1")]
    new = [m for m in poses(output, "wedge_retrack") if isinstance(m, ObjectPose)]
    assert [(m.sequence, m.time_ns) for m in new] == [
        (10 + number, 10**18 + number * FRAME_NS) for number in range(FRAMES)
    ]
    assert {m.object for m in new} == {"wedge_retrack"}
    assert Counter(m.state for m in new)["lost"] < FRAMES
    assert verify_recording(output) == []
    metadata = read_metadata(output)
    assert read_metadata(path)[LOSSES_RECORD] == metadata[LOSSES_RECORD]
    assert metadata["retrack"]["poses"] == "wedge=wedge_retrack"
    assert metadata["retrack"]["models"] == "wedge.model"
    (told,) = json.loads(result.read_text())["retracked"]
    assert (told["frames"], told["with_pictures"], told["skipped"]) == (FRAMES, FRAMES - 2, False)
    (problem,) = told["problems"]
    assert problem.startswith("a picture cannot be read")


@pytest.mark.long
def test_the_result_is_the_same_again_with_two_jobs(tmp_path: Path, model: Path) -> None:
    files = [recorded(tmp_path / f"{seed}.mcap", seed=seed) for seed in range(2)]
    for jobs in ("1", "2"):
        assert retrack(model, *files, folder=tmp_path / jobs, more=("--jobs", jobs)) == 0
    for file in files:
        first, second = ((tmp_path / jobs / file.name).read_bytes() for jobs in ("1", "2"))
        assert first == second


@pytest.mark.long
def test_what_is_whole_is_skipped_and_what_is_half_is_done_anew(
    tmp_path: Path, model: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = [recorded(tmp_path / f"{seed}.mcap", seed=seed) for seed in range(2)]
    folder = tmp_path / "again"
    assert retrack(model, *files, folder=folder) == 0
    whole = {path.name: path.read_bytes() for path in folder.iterdir()}
    half = folder / "1.mcap"
    (folder / "1.mcap.part").write_bytes(half.read_bytes()[:3000])
    half.unlink()
    untouched = (folder / "0.mcap").stat().st_mtime_ns
    capsys.readouterr()
    assert retrack(model, *files, folder=folder) == 0
    first, second, *_ = capsys.readouterr().out.splitlines()
    assert first == f"{folder / '0.mcap'}: there already"
    assert second.startswith(f"{half}: 12 frames, 10 with a picture; wedge: ")
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == whole
    assert (folder / "0.mcap").stat().st_mtime_ns == untouched


@pytest.mark.long
def test_a_result_of_something_else_is_not_taken_for_done(
    tmp_path: Path, model: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path, folder = recorded(tmp_path / "walk.mcap"), tmp_path / "again"
    assert retrack(model, path, folder=folder) == 0
    assert retrack(model, path, folder=folder, more=("--tracker", "other")) == 1
    assert "is of another recording, model, setting or release" in capsys.readouterr().err
    (tmp_path / "other").mkdir()
    other = recorded(tmp_path / "other" / "walk.mcap", person=8)
    assert other.stat().st_size == path.stat().st_size
    assert retrack(model, other, folder=folder) == 1
    assert "is of another recording, model, setting or release" in capsys.readouterr().err
    again = tmp_path / "twice"
    assert retrack(model, folder / "walk.mcap", folder=again, more=("--tracker", "other")) == 0
    names = {m.name for m in read_recording(again / "walk.mcap", streams=("pose",))}
    assert names == {"wedge", "wedge_retrack", "wedge_other"}
    assert retrack(model, folder / "walk.mcap", folder=tmp_path / "same") == 1
    assert "has poses of wedge_retrack already: choose another --tr" in capsys.readouterr().err


def test_settings_of_a_rigs_tracker_are_taken(tmp_path: Path, model: Path) -> None:
    path = recorded(tmp_path / "walk.mcap")
    config = tmp_path / "rig.toml"
    config.write_text(f'[tracker.mine]\ncamera = "front"\nseed = 3\nmodel = "{model}"\n')
    arguments = ["--config", str(config), "-o", str(tmp_path / "again"), "--jobs", "1"]
    assert main(["recording", "retrack", str(path), *arguments]) == 0
    record = read_metadata(tmp_path / "again" / "walk.mcap")["retrack"]
    assert (record["tracker"], record["poses"]) == ("mine", "wedge=wedge_mine")
    assert json.loads(record["settings"])["seed"] == 3


@pytest.mark.parametrize(
    ("damage", "more", "code", "line"),
    [
        ("cut", (), 1, "was cut off: `inhand recording recover"),
        ("missing", (), 1, "walk.mcap does not exist: check the path"),
        ("blind", (), 1, "has no skeletons: `inhand recording skeletons` adds those"),
        ("none", ("--camera", "side"), 1, "has no skeletons of camera 'side', but of: front"),
        ("none", ("--tracker", "x" * 60), 1, "choose a shorter --tracker"),
        ("model", (), 2, "wedge.model does not exist: check the path; `inhand train` makes it"),
    ],
)
def test_what_cannot_be_tracked_is_said_in_one_line_and_nothing_stays(
    tmp_path: Path,
    model: Path,
    capsys: pytest.CaptureFixture[str],
    damage: str,
    more: tuple[str, ...],
    code: int,
    line: str,
) -> None:
    path = recorded(tmp_path / "walk.mcap", skeletons=damage != "blind")
    if damage == "cut":
        path.write_bytes(path.read_bytes()[:5000])
    if damage == "missing":
        path.unlink()
    chosen = tmp_path / "wedge.model" if damage == "model" else model
    assert retrack(chosen, path, folder=tmp_path / "again", more=more) == code
    (said,) = capsys.readouterr().err.splitlines()
    assert line in said
    assert list((tmp_path / "again").glob("*")) == []


def test_two_of_one_name_and_its_own_folder_are_refused(
    tmp_path: Path, model: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = recorded(tmp_path / "walk.mcap")
    assert retrack(model, path, tmp_path / "other" / "walk.mcap", folder=tmp_path / "again") == 2
    assert retrack(model, path, folder=tmp_path) == 2
    two, own = capsys.readouterr().err.splitlines()
    assert "two recordings are named walk.mcap" in two
    assert "would be overwritten: choose another folder than its own" in own

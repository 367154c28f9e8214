"""Training on skeletons of upper bodies: what is learned, and what is refused."""

from pathlib import Path

import pytest
from inhand_lab.datasets.dataset import Dataset, DatasetError
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.datasets.generation import GenerationSettings, generate
from inhand_lab.evaluation.folds import leave_one_out, train_on_one_test_on_other
from inhand_lab.evaluation.protocol import Protocol, evaluate
from inhand_lab.training.model_training import train
from inhand_schemas.joints import JOINT_NAMES, Joint
from inhand_tracker.model.model_file import load_model
from lacking import lacking
from waving import box, entry_of, messages, write_dataset

from inhand.__main__ import main

LEGS = tuple(i for i, name in enumerate(JOINT_NAMES) if name.startswith(("Knee", "Ankle", "Foot")))
TABLE = (*LEGS, Joint.HIP_CENTER, Joint.SPINE, Joint.HIP_LEFT, Joint.HIP_RIGHT)
HANDS = (Joint.HAND_LEFT, Joint.HAND_RIGHT)


def vertex_error_cm(trained: Dataset, tested: Dataset | None = None) -> float:
    """The mean vertex error of fusion, of bodies alone."""
    folds = (
        leave_one_out(trained) if tested is None else train_on_one_test_on_other(trained, tested)
    )
    protocol = Protocol(trained, tested or trained, tuple(folds), ("fusion",), ((),), 1)
    trials = evaluate(protocol, 1)
    return 100.0 * sum(trial.score.vertex_error_m for trial in trials) / len(trials)


@pytest.mark.long
def test_a_model_of_upper_bodies_is_saved_with_the_joints_that_it_does_not_know(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    write_dataset(tmp_path / "in", missing=TABLE)
    assert main(["train", str(tmp_path / "in"), "-o", str(tmp_path / "m")]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "left out, as no recording shows them: HipCenter, Spine, HipLeft" in shown
    assert load_model(tmp_path / "m").mapping.absent_joints == tuple(sorted(TABLE))


@pytest.fixture(scope="module")
def whole_cm(tmp_path_factory: pytest.TempPathFactory) -> float:
    """The vertex error of whole bodies."""
    return vertex_error_cm(write_dataset(tmp_path_factory.mktemp("whole"), frames=60))


@pytest.mark.long
@pytest.mark.parametrize("missing", [LEGS, TABLE, (*TABLE, *HANDS)])
def test_upper_bodies_are_tracked_nearly_as_well_as_whole_ones(
    tmp_path: Path, whole_cm: float, missing: tuple[int, ...]
) -> None:
    upper = vertex_error_cm(write_dataset(tmp_path / "upper", frames=60, missing=missing))
    assert upper < 1.3 * whole_cm + 0.3


@pytest.mark.long
def test_simulated_people_are_followed_nearly_as_well_by_their_upper_bodies(
    tmp_path: Path,
) -> None:
    interactions = ["drinkFromMug", "hammerNail"]
    whole = generate(
        tmp_path / "whole",
        GenerationSettings(interactions, 3, 73, 90, images=False),
        lambda: None,
    )
    errors = {"whole": vertex_error_cm(whole)}
    for name, missing in {"no legs": LEGS, "no hips": TABLE, "no hands": (*TABLE, *HANDS)}.items():
        errors[name] = vertex_error_cm(lacking(whole, tmp_path / name, missing))
    print({name: round(error, 2) for name, error in errors.items()})
    assert max(errors.values()) < 1.35 * errors["whole"]


@pytest.mark.long
def test_a_model_of_upper_bodies_tracks_whole_ones(tmp_path: Path) -> None:
    upper = write_dataset(tmp_path / "upper", frames=60, missing=TABLE)
    whole = write_dataset(tmp_path / "whole", 1, frames=60, first=9)
    lacking = write_dataset(tmp_path / "lacking", 1, frames=60, first=9, missing=TABLE)
    assert vertex_error_cm(upper, whole) == pytest.approx(vertex_error_cm(upper, lacking))


@pytest.mark.long
def test_people_without_a_pelvis_are_not_tested_by_what_whole_ones_taught(tmp_path: Path) -> None:
    whole = write_dataset(tmp_path / "whole")
    lacking = write_dataset(tmp_path / "lacking", 1, first=9, missing=TABLE)
    with pytest.raises(DatasetError, match="never shows a pelvis"):
        vertex_error_cm(whole, lacking)


def test_recordings_that_lack_different_joints_are_refused(tmp_path: Path) -> None:
    writer = DatasetWriter(tmp_path)
    writer.add_shape(box())
    for seed, missing in enumerate((LEGS, ())):
        writer.add_recording(entry_of(f"p{seed}"), messages(30, seed, missing=missing))
    dataset = writer.finish({})
    with pytest.raises(DatasetError, match=r"one of them never has KneeLeft, AnkleLeft") as caught:
        train(dataset, dataset.entries)
    assert "p0.mcap and recordings/p1.mcap" in str(caught.value)


@pytest.mark.parametrize(
    ("missing", "complaint"),
    [
        ((*TABLE, Joint.WRIST_LEFT), "WristLeft most often"),
        ((*LEGS, Joint.SHOULDER_CENTER), "ShoulderCenter most often"),
    ],
)
def test_joints_without_which_nothing_is_known_are_named(
    tmp_path: Path, missing: tuple[int, ...], complaint: str
) -> None:
    dataset = write_dataset(tmp_path, missing=missing)
    with pytest.raises(DatasetError, match=complaint) as caught:
        train(dataset, dataset.entries)
    assert "or legs, hips, spine or hands never" in str(caught.value)

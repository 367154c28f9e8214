"""``inhand recognise`` and what it stands on, on a small simulated world."""

import json
from pathlib import Path

import numpy as np
import pytest
from inhand_lab.datasets.dataset import Dataset
from inhand_lab.datasets.generation import GenerationSettings, generate
from inhand_lab.datasets.recorded_frames import load_frames
from inhand_lab.recognition.cascade_learning import learn_cascade
from inhand_runtime.errors import SettingsError
from inhand_tracker.loading import load_watcher
from inhand_tracker.methods.darby2014.tracker import ParticleTracker
from inhand_tracker.methods.darby2014.variants import VARIANTS
from inhand_tracker.model.model import Model, ModelError
from inhand_tracker.model.model_file import save_model
from inhand_tracker.people.watching import CameraFrame
from inhand_tracker.recognition.cascade import Cascade
from inhand_tracker.recognition.darby2012.cascade import Cascade2012
from inhand_tracker.recognition.recogniser import Recogniser
from inhand_tracker.recognition.recogniser_file import load_recogniser, save_recogniser
from inhand_tracker.recognition.recognition import Recognition
from inhand_tracker.settings import TrackerSettings
from inhand_tracker.wire.conversion import joints_of

from inhand.__main__ import main

pytestmark = [pytest.mark.long, pytest.mark.timeout(900)]

ACTIONS = ("hammerNail", "putOnShoe")


@pytest.fixture(scope="module")
def people(tmp_path_factory: pytest.TempPathFactory) -> Dataset:
    folder = tmp_path_factory.mktemp("world") / "set"
    return generate(folder, GenerationSettings(ACTIONS, 5, 5, 240, images=False), lambda: None)


@pytest.fixture(scope="module")
def learned(people: Dataset) -> tuple[Recogniser, list[Model]]:
    others = [entry for entry in people.entries if entry.participant != "p04"]
    return learn_cascade(people, others, images=False)


def follow(
    cascade: Cascade | Cascade2012, people: Dataset, action: str, frames: int | None = None
) -> list[Recognition]:
    """What it answers in an unseen person's first frames, or in all of them."""
    (entry,) = (e for e in people.entries if (e.interaction, e.participant) == (action, "p04"))
    return [
        cascade.step(joints_of(frame.people[0]) if frame.people else None, frame.time_ns)
        for frame in load_frames(people.path(entry), entry.object)[:frames]
    ]


def cascades(learned: tuple[Recogniser, list[Model]]) -> list[Cascade | Cascade2012]:
    recogniser, models = learned
    trackers = [ParticleTracker(model, VARIANTS["gd-hand"]) for model in models]
    return [Cascade2012(recogniser, models), Cascade(recogniser, trackers)]


@pytest.mark.parametrize("which", [0, 1])
def test_an_unseen_person_s_object_is_recognised_and_placed(
    people: Dataset, learned: tuple[Recogniser, list[Model]], which: int
) -> None:
    cascade = cascades(learned)[which]
    for number, action in enumerate(ACTIONS):
        cascade.restart()
        used = follow(cascade, people, action)[80:]
        known = [answer.known for answer in used if answer.known is not None]
        assert len(known) > 0.5 * len(used)
        assert np.mean([one == number for one in known]) > 0.9
        for answer in used:
            assert (answer.known is None) == (answer.estimate.translation is None)
            assert answer.probabilities.sum() <= 1.0 + 1e-9


def test_the_same_frames_give_the_same_answers(
    people: Dataset, learned: tuple[Recogniser, list[Model]]
) -> None:
    for first, second in zip(cascades(learned), cascades(learned), strict=True):
        for one, other in zip(
            follow(first, people, ACTIONS[0], 60),
            follow(second, people, ACTIONS[0], 60),
            strict=True,
        ):
            np.testing.assert_array_equal(one.probabilities, other.probabilities)
            if one.estimate.translation is not None:
                np.testing.assert_array_equal(one.estimate.translation, other.estimate.translation)


def test_a_recogniser_s_file_gives_the_same_answers(
    learned: tuple[Recogniser, list[Model]], tmp_path: Path
) -> None:
    recogniser, _ = learned
    save_recogniser(recogniser, tmp_path / "r")
    again = load_recogniser(tmp_path / "r")
    assert again.actions == recogniser.actions
    features = recogniser.movements.means + np.linspace(-1, 1, len(recogniser.movements.means))
    np.testing.assert_array_equal(
        again.movements.evidence(features[None]), recogniser.movements.evidence(features[None])
    )
    poses = recogniser.body_poses[:5]
    np.testing.assert_array_equal(
        again.svm.probabilities(poses), recogniser.svm.probabilities(poses)
    )


def test_a_recogniser_of_a_release_without_arms_loads_and_does_without_them(
    learned: tuple[Recogniser, list[Model]], tmp_path: Path
) -> None:
    recogniser, _ = learned
    save_recogniser(recogniser, tmp_path / "new")
    assert load_recogniser(tmp_path / "new").movements.arms is not None
    with np.load(tmp_path / "new") as archive:
        older = {name: archive[name] for name in archive if not name.startswith("courses.")}
    with (tmp_path / "older").open("wb") as file:
        np.savez(file, **older)
    again = load_recogniser(tmp_path / "older")
    assert again.movements.arms is None
    np.testing.assert_array_equal(again.movements.limits, recogniser.movements.limits)


@pytest.mark.exhaustive
def test_recognition_is_measured_on_the_people_of_another_dataset(
    people: Dataset, tmp_path: Path
) -> None:
    report = tmp_path / "on.json"
    folder = str(people.folder)
    arguments = ["--test-on", folder, "--taught-by", "p00,p01", "--json", str(report)]
    assert main(["recognise", folder, *arguments]) == 0
    counts = json.loads(report.read_text())["counts"]
    taught = [count for count in counts if count["kind"] == "taught"]
    assert {count["action"] for count in taught} == set(ACTIONS)
    assert all(count["right"] > 0.5 * count["frames"] for count in taught)
    assert sum(count["wrong"] for count in taught) == 0
    assert main(["recognise", folder, "--test-on", folder, "--taught-by", "nobody"]) != 0


@pytest.mark.parametrize("damage", ["missing", "foreign", "cut"])
def test_a_file_that_is_no_recogniser_is_refused_in_one_line(
    learned: tuple[Recogniser, list[Model]], tmp_path: Path, damage: str
) -> None:
    path = tmp_path / "r"
    if damage == "foreign":
        with path.open("wb") as file:
            np.savez(file, other=np.zeros(3))
    elif damage == "cut":
        save_recogniser(learned[0], path)
        path.write_bytes(path.read_bytes()[:5000])
    with pytest.raises(ModelError) as refused:
        load_recogniser(path)
    assert str(path) in str(refused.value)
    assert "\n" not in str(refused.value)


def test_the_tracker_s_settings_name_a_recogniser_and_all_its_models(
    learned: tuple[Recogniser, list[Model]], tmp_path: Path
) -> None:
    recogniser, models = learned
    save_recogniser(recogniser, tmp_path / "r")
    files = []
    for model in models:
        files.append(tmp_path / f"{model.shape.name}.model")
        save_model(model, files[-1])
    settings = TrackerSettings(
        models=tuple(files), recogniser=tmp_path / "r", likelihood=(), method="gd-hand"
    )
    watcher = load_watcher("x", settings)
    assert watcher.names == tuple(model.shape.name for model in models)
    seen = watcher.see(None, CameraFrame(0), lambda *_: None)
    assert {one.estimate.state for one in seen} == {"lost"}
    with pytest.raises(SettingsError, match=r"\[tracker.x\] recognises 'putOnShoe' and has no"):
        load_watcher("x", settings.model_copy(update={"models": tuple(files[:1])}))


@pytest.mark.exhaustive
def test_the_command_measures_both_cascades(people: Dataset, tmp_path: Path) -> None:
    file = tmp_path / "result.json"
    arguments = ["recognise", str(people.folder), "--unseen", "p04", "--json", str(file)]
    arguments += ["--light", "0.85,1,1.15"]
    assert main([*arguments, "--report", str(tmp_path / "report")]) == 0
    result = json.loads(file.read_text())
    assert set(result["methods"]) == {"cascade-2012", "cascade"}
    for method in result["methods"].values():
        assert set(method["interactions"]) == set(ACTIONS)
        assert method["precision_percent"] > 60.0
        assert 0.0 < method["known_percent"] <= 100.0
    # Without images no light shows.
    assert result["lights"]["0.85,1,1.15"]["methods"] == result["methods"]
    report = (tmp_path / "report" / "recognition.md").read_text()
    assert "cascade-2012, 0.85,1,1.15" in report


@pytest.mark.exhaustive
def test_recognition_alone_leaves_every_person_out(people: Dataset, tmp_path: Path) -> None:
    file, report = tmp_path / "result.json", tmp_path / "report"
    arguments = ["recognise", str(people.folder), "--alone", "--json", str(file)]
    assert main([*arguments, "--report", str(report)]) == 0
    result = json.loads(file.read_text())
    assert result["sequences_percent"] == 100.0
    assert result["actions"] == list(ACTIONS)
    assert (report / "confusion.png").stat().st_size > 1000


def test_an_unknown_participant_is_one_line(
    people: Dataset, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["recognise", str(people.folder), "--unseen", "nobody"]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line == "inhand recognise: no participant 'nobody'; there are: p00, p01, p02, p03, p04"


@pytest.mark.parametrize("light", ["0.85,1", "0,1,1", "red", "1,inf,1"])
def test_a_light_that_is_none_is_one_line(
    people: Dataset, capsys: pytest.CaptureFixture[str], light: str
) -> None:
    assert main(["recognise", str(people.folder), "--light", light]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"inhand recognise: --light {light}: not three factors")


def test_a_recogniser_is_trained_by_a_command(people: Dataset, tmp_path: Path) -> None:
    path = tmp_path / "r"
    command = ["train", str(people.folder), "-o", str(path), "--recogniser"]
    assert main([*command, "--without", "p04"]) == 0
    assert load_recogniser(path).actions == ACTIONS
    assert main([*command, "--without", "p04", "--object", "hammer"]) == 2

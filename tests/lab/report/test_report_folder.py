"""The folder of an evaluation's report."""

import json
from pathlib import Path

from inhand_lab.datasets.dataset import Dataset
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.evaluation.folds import leave_one_out
from inhand_lab.evaluation.protocol import Protocol, Terms, evaluate
from inhand_lab.evaluation.summary import summarise, terms_name, with_terms, worth
from inhand_lab.report.report_folder import prepare_report_folder, write_report
from waving import box, entry_of, messages, write_dataset

EDGES: Terms = ("edges",)
NONE: Terms = ()


def protocol(dataset: Dataset, methods: tuple[str, ...], terms: tuple[Terms, ...]) -> Protocol:
    return Protocol(dataset, dataset, tuple(leave_one_out(dataset)), methods, terms, 1)


def test_the_report_holds_tables_sequences_and_the_papers_figures(tmp_path: Path) -> None:
    dataset = write_dataset(tmp_path / "set", frames=20, images=True)
    plan = protocol(dataset, ("g-hand", "gd-stable-proximate"), (EDGES, NONE))
    trials = evaluate(plan, 1)
    result = {
        "methods": summarise(with_terms(trials, EDGES)),
        "terms": terms_name(EDGES),
        "compared": {"none": summarise(with_terms(trials, NONE))},
        "worth": {"none": worth(trials, EDGES, NONE)},
        "notes": [],
        "frames": 240,
        "seconds": 1.0,
    }
    folder = tmp_path / "report"
    prepare_report_folder(folder)
    write_report(folder, plan, trials, result, 1)
    pictures = [f"{name}_wave.png" for name in ("spread", "rotation", "translation")]
    pictures.append("frames_wave.jpg")
    names = {"evaluation.json", "report.md", "sequences.tsv", "table.txt", *pictures}
    assert {file.name for file in folder.iterdir()} == names
    assert all((folder / picture).stat().st_size > 5_000 for picture in pictures)
    text = (folder / "report.md").read_text()
    assert all(f"({picture})" in text for picture in pictures)
    assert "12.6" in text
    header, *lines = (folder / "sequences.tsv").read_text().splitlines()
    assert header.split("\t")[:3] == ["method", "terms", "seed"]
    assert len(lines) == len(trials) == 12
    assert json.loads((folder / "evaluation.json").read_text())["terms"] == "edges"
    assert "gd-stable-" in (folder / "table.txt").read_text()


def test_a_recording_without_camera_and_with_an_odd_name_is_reported_without_frames(
    tmp_path: Path,
) -> None:
    writer = DatasetWriter(tmp_path / "set")
    writer.add_shape(box())
    for seed in range(3):
        entry = entry_of(f"p{seed}", interaction="wave/../it")
        writer.add_recording(entry, list(messages(10, seed))[1:])
    plan = protocol(writer.finish({"name": "odd"}), ("gd-stable-proximate",), (NONE,))
    trials = evaluate(plan, 1)
    result = {
        "methods": summarise(trials),
        "terms": "none",
        "compared": {},
        "worth": {},
        "notes": [],
        "frames": 30,
        "seconds": 1.0,
    }
    prepare_report_folder(tmp_path / "report")
    write_report(tmp_path / "report", plan, trials, result, 1)
    assert sorted(file.name for file in (tmp_path / "report").glob("*_*.*g")) == [
        "rotation_wave_it.png",
        "spread_wave_it.png",
        "translation_wave_it.png",
    ]

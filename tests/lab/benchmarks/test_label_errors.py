"""Errors of labels between keyframes."""

from pathlib import Path

import pytest
from inhand_lab.benchmarks.label_errors import (
    COUNTED_KINDS,
    KINDS,
    LabelCheck,
    LabelErrors,
    check_labels,
    chosen_entries,
    reaches_aims,
)
from inhand_lab.benchmarks.parameters import DEFAULT_LABEL_CHECK
from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.datasets.generation import GenerationSettings, generate
from waving import write_dataset

from inhand.bench_label_tables import labels_table


def test_the_recordings_of_the_first_people_are_chosen(tmp_path: Path) -> None:
    dataset = write_dataset(tmp_path / "waving", 4)
    ((interaction, entries),) = chosen_entries(dataset).items()
    assert interaction == "wave"
    assert [entry.participant for entry in entries] == ["p0", "p1"]


@pytest.mark.long
def test_a_dataset_that_does_not_say_what_is_visible_is_refused(tmp_path: Path) -> None:
    dataset = write_dataset(tmp_path / "waving", 2)
    with pytest.raises(DatasetError, match="does not say how much of its object is visible"):
        list(check_labels(dataset, lambda: None))


@pytest.mark.long
def test_all_kinds_of_labels_are_measured_on_the_same_frames(tmp_path: Path) -> None:
    settings = GenerationSettings(("drinkFromMug",), participants=1, seed=3, frames=41)
    dataset = generate(tmp_path / "drinking", settings, lambda: None)
    seen: list[None] = []
    (check,) = check_labels(dataset, lambda: seen.append(None))
    assert len(seen) == 1
    assert tuple(one.kind for one in check.visible) == KINDS
    for visible, hidden in zip(check.visible, check.hidden, strict=True):
        assert visible.frames + hidden.frames == 41 - 3
        assert visible.translation_mm is not None
    assert [one.kind for one in check.needed] == list(COUNTED_KINDS)
    assert check.visible[2].doubt_correlation is not None
    assert check.visible[0].doubt_correlation is None


def test_a_table_shows_hidden_frames_where_there_are_some() -> None:
    row = tuple(LabelErrors(kind, 10, 4.0, 1.5, None) for kind in KINDS)
    none = tuple(LabelErrors(kind, 0) for kind in KINDS)
    group = labels_table([LabelCheck("a", row, none), LabelCheck("b", row, row)])
    assert [table.row_count for table in group.renderables] == [2, 1, 2]  # type: ignore[union-attr]


@pytest.mark.parametrize(
    ("visible", "hidden", "reached"),
    [
        ((5.0, 2.0), (None, None), True),
        ((5.0, 2.0), (10.0, 4.0), True),
        ((5.1, 2.0), (10.0, 4.0), False),
        ((5.0, 2.1), (10.0, 4.0), False),
        ((5.0, 2.0), (10.1, 4.0), False),
        ((5.0, 2.0), (10.0, 4.1), False),
    ],
)
def test_aims_are_reached_in_place_and_in_turn_wherever_there_are_frames(
    visible: tuple[float, float], hidden: tuple[float | None, float | None], reached: bool
) -> None:
    shown, covered = (LabelErrors("plain", 9, *one) for one in (visible, hidden))
    assert reaches_aims(shown, covered, DEFAULT_LABEL_CHECK) == reached

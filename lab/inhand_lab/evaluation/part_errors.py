"""Measures how well each part of the body, and all of them together, predict an object's pose.

Each part's prediction is the mean over the cluster of the nearest training pose: what the particles
of a method come to that redraws all of them in every frame and has no image. So the errors explain
the order of the methods.

``python -m inhand_lab.evaluation.part_errors DATASET`` shows them by the joints that were measured
and, in a simulated dataset, by the true ones.
"""

import argparse
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from inhand_tracker.body.reader import Body, BodyReader
from inhand_tracker.body.skeleton import PARTS, RIGHT_HAND, mirror_pose
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Indices
from inhand_tracker.mapping.body_pose_index import BodyPoseIndex
from inhand_tracker.mapping.labelled_sequence import LabelledSequence
from inhand_tracker.mapping.learning import learn
from inhand_tracker.mapping.mapping import Mapping
from inhand_tracker.methods.darby2014.particles import mixing_fractions
from rich.console import Console
from rich.table import Table

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, load_dataset
from inhand_lab.datasets.labelled_sequence import labelled_sequence
from inhand_lab.datasets.stretches import entry_frames
from inhand_lab.datasets.tracks import true_joints
from inhand_lab.evaluation.folds import Fold, leave_one_out
from inhand_lab.evaluation.parameters import DEFAULT_EVALUATION
from inhand_lab.evaluation.vertex_error import vertex_error

CHOICES = ("hand", "all parts", "stable", "stable, proximate")
"""The parts from which gd-hand, gd-random, gd-stable and gd-stable-proximate predict."""


@dataclass(frozen=True)
class PartErrors:
    """Errors of predictions in metres and radians, means over frames.

    ``translation_m`` and ``rotation_rad`` (20,) are those of the 19 parts and of the mean of all,
    ``vertex_m`` (4,) those of CHOICES; ``fractions`` (2,) are α and β.
    """

    translation_m: Array
    rotation_rad: Array
    vertex_m: Array
    fractions: Array


def measure_part_errors(dataset: Dataset, *, by_true_joints: bool) -> PartErrors:
    """Measure the errors for unseen people, means over interactions; raises DatasetError.

    With true joints, these replace the measured ones in learning and in testing.
    """
    folds = leave_one_out(dataset)
    sequences = {
        entry: _sequence(dataset, entry, by_true_joints)
        for entry in dict.fromkeys(e for fold in folds for e in (*fold.trained, *fold.tested))
    }
    by_interaction: dict[str, list[PartErrors]] = {}
    for fold in folds:
        by_interaction.setdefault(fold.interaction, []).extend(
            _fold_errors(dataset, fold, sequences)
        )
    return _mean([_mean(errors) for errors in by_interaction.values()])


def predict_by_parts(mapping: Mapping, cluster: Indices, body: Body) -> tuple[Array, Array]:
    """Predict by each of the 19 parts, and by the mean of all, as if the person were right-handed.

    Returns translations (20, 3) and rotations (20, 4) in the camera frame.
    """
    upright = np.array([1.0, 0.0, 0.0, 0.0])
    places, _ = body.parts.to_camera(mapping.translations[cluster] * body.height, upright)
    _, turns = body.parts.to_camera(np.zeros(3), mapping.rotations[cluster])
    scatter = np.einsum("npi,npj->pij", turns, turns)
    whole = np.concatenate((scatter, scatter.sum(axis=0, keepdims=True)))
    means = places.mean(axis=0)
    return np.vstack((means, means.mean(axis=0))), rotations.principal(whole)


def _fold_errors(
    dataset: Dataset, fold: Fold, sequences: dict[DatasetEntry, LabelledSequence]
) -> Iterator[PartErrors]:
    shape = dataset.shape(str(fold.trained[0].object))
    mapping = learn([sequences[entry] for entry in fold.trained], shape.mirror_normal)
    index = BodyPoseIndex(mapping)
    for entry in fold.tested:
        tested = sequences[entry]
        reader = BodyReader(mapping, left_handed=tested.left_handed)
        for frame, joints in enumerate(tested.joints):
            body = reader.read(joints)
            truth = tested.translations[frame], tested.rotations[frame]
            if (
                frame % DEFAULT_EVALUATION.part_errors_step
                or body is None
                or not np.isfinite(truth[0]).all()
            ):
                continue
            nearest, _ = index.nearest(body.pose)
            predicted = predict_by_parts(mapping, index.cluster(nearest), body)
            if tested.left_handed:
                predicted = mirror_pose(*predicted, shape.mirror_normal)
            yield PartErrors(
                np.linalg.norm(predicted[0] - truth[0], axis=-1),
                rotations.angle_between(predicted[1], truth[1]),
                _vertex_errors(mapping, nearest, predicted, truth, shape.marked_vertices),
                np.array(mixing_fractions(mapping, nearest)),
            )


def _vertex_errors(
    mapping: Mapping,
    nearest: int,
    predicted: tuple[Array, Array],
    truth: tuple[Array, Array],
    marked_vertices: Array,
) -> Array:
    everything, turn = len(PARTS), mapping.stable_rotation_part[nearest]
    moves = [
        RIGHT_HAND,
        everything,
        mapping.stable_translation_part[nearest],
        mapping.proximate_part[nearest],
    ]
    turns = [RIGHT_HAND, everything, turn, turn]
    return vertex_error((predicted[0][moves], predicted[1][turns]), truth, marked_vertices)


def _sequence(dataset: Dataset, entry: DatasetEntry, by_true_joints: bool) -> LabelledSequence:
    sequence = labelled_sequence(dataset, entry)
    if not by_true_joints:
        return sequence
    return replace(sequence, joints=true_joints(entry_frames(dataset, entry)))


def _mean(errors: Sequence[PartErrors]) -> PartErrors:
    return PartErrors(
        np.mean([one.translation_m for one in errors], axis=0),
        np.mean([one.rotation_rad for one in errors], axis=0),
        np.mean([one.vertex_m for one in errors], axis=0),
        np.mean([one.fractions for one in errors], axis=0),
    )


def _table(columns: dict[str, PartErrors]) -> Table:
    table = Table("predicted from")
    for name in columns:
        table.add_column(f"{name}: cm", justify="right")
        table.add_column("degrees", justify="right")
    rows = {part: slice(number, number + 1) for number, part in enumerate(PARTS)}
    rows |= {"one part, on average": slice(0, len(PARTS)), "all parts' mean": slice(-1, None)}
    for name, row in rows.items():
        cells = []
        for errors in columns.values():
            cells.append(f"{100 * errors.translation_m[row].mean():.1f}")
            cells.append(f"{np.degrees(errors.rotation_rad[row].mean()):.1f}")
        table.add_row(name, *cells)
    table.add_section()
    for number, choice in enumerate(CHOICES):
        vertex = (f"{100 * errors.vertex_m[number]:.1f}" for errors in columns.values())
        table.add_row(f"vertices, {choice}", *_spaced(vertex))
    for number, symbol in enumerate(("α", "β")):
        table.add_row(symbol, *_spaced(f"{e.fractions[number]:.3f}" for e in columns.values()))
    return table


def _spaced(cells: Iterable[str]) -> Iterator[str]:
    """Yield cells of centimetres, with nothing in the columns of degrees."""
    for cell in cells:
        yield from (cell, "")


def main() -> None:
    """Show the errors of a dataset's parts."""
    parser = argparse.ArgumentParser(
        prog="python -m inhand_lab.evaluation.part_errors", description=__doc__
    )
    parser.add_argument("dataset", type=Path, metavar="DATASET")
    dataset = load_dataset(parser.parse_args().dataset)
    columns = {"measured": measure_part_errors(dataset, by_true_joints=False)}
    truth = measure_part_errors(dataset, by_true_joints=True) if _simulated(dataset) else None
    Console().print(_table(columns if truth is None else {**columns, "true": truth}))


def _simulated(dataset: Dataset) -> bool:
    entry = dataset.entries[0]
    return bool(np.isfinite(true_joints(entry_frames(dataset, entry))).any())


if __name__ == "__main__":
    main()

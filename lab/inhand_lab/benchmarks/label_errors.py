"""Measures how far labels between keyframes are from the truth, in a simulated dataset.

Keyframes are the truth with a person's inaccuracy; only the frames between them are measured.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array, Flags
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.viewpoints import Viewpoints, find_viewpoints
from inhand_tracker.wire.poses import pose_message

from inhand_lab.benchmarks.parameters import DEFAULT_LABEL_CHECK, LabelCheckParameters
from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.recorded_frames import RecordedFrame, labelled_camera, load_frames
from inhand_lab.datasets.tracks import Track, true_track
from inhand_lab.evaluation.pose_errors import ErrorGauge
from inhand_lab.labelling.assisted_labels import assist
from inhand_lab.labelling.interpolation import interpolate
from inhand_lab.labelling.keyframes import Keyframe
from inhand_lab.labelling.scene import Scene, load_scene

KINDS = ("plain", "hand", "assisted", "both")
"""Names of how labels are made: interpolated in the camera's frame, or relative to the hand that a
person prefers; and the same two refined by the images."""


@dataclass(frozen=True)
class LabelErrors:
    """Median errors of one kind of labels in some frames, in mm and degrees, None without frames;
    and where images were used the rank correlation of the doubts with the errors in mm."""

    kind: str
    frames: int
    translation_mm: float | None = None
    rotation_deg: float | None = None
    doubt_correlation: float | None = None


@dataclass(frozen=True)
class LabelCheck:
    """An interaction's errors by ``KINDS``: of frames in which at least a third of the object is
    ``visible``, and of the others, ``hidden``."""

    interaction: str
    visible: tuple[LabelErrors, ...]
    hidden: tuple[LabelErrors, ...]


@dataclass(frozen=True)
class _Measured:
    """Errors of N labels between keyframes in mm and degrees, their doubts in metres, NaN where no
    image was used, and the share of the object that is visible, each (N,)."""

    translation_mm: Array
    rotation_deg: Array
    doubts: Array
    visible: Array


def chosen_entries(
    dataset: Dataset, parameters: LabelCheckParameters = DEFAULT_LABEL_CHECK
) -> dict[str, list[DatasetEntry]]:
    """Choose the recordings of the first few people, by interaction; raises DatasetError."""
    people = list(dict.fromkeys(entry.participant for entry in dataset.entries))
    chosen = [
        entry
        for entry in dataset.entries
        if entry.object is not None and entry.participant in people[: parameters.people]
    ]
    if not chosen:
        raise DatasetError(
            f"{dataset.folder} has no labelled object: give one of `inhand simulate`"
        )
    return {
        interaction: [entry for entry in chosen if entry.interaction == interaction]
        for interaction in dict.fromkeys(entry.interaction for entry in chosen)
    }


def check_labels(
    dataset: Dataset,
    on_recording: Callable[[], None],
    parameters: LabelCheckParameters = DEFAULT_LABEL_CHECK,
) -> Iterator[LabelCheck]:
    """Yield each interaction's errors; raises DatasetError, or LabellingError without images."""
    for interaction, entries in chosen_entries(dataset, parameters).items():
        shape = dataset.shape(str(entries[0].object))
        viewpoints = find_viewpoints(shape)
        measured: dict[str, list[_Measured]] = {kind: [] for kind in KINDS}
        for number, entry in enumerate(entries):
            random = np.random.default_rng((parameters.seed, number))
            for kind, one in _measure(dataset, entry, shape, viewpoints, random, parameters):
                measured[kind].append(one)
            on_recording()
        yield _check(interaction, measured, parameters)


def _measure(
    dataset: Dataset,
    entry: DatasetEntry,
    shape: ObjectShape,
    viewpoints: Viewpoints,
    random: np.random.Generator,
    parameters: LabelCheckParameters,
) -> Iterator[tuple[str, _Measured]]:
    """Label a recording in every way, from the same keyframes."""
    path = dataset.path(entry)
    frames = load_frames(path, entry.object)
    scene = load_scene(path, labelled_camera(frames) or "camera")
    truth, gauge = true_track(frames), ErrorGauge(shape)
    visible, placed = _visible(entry, frames), _inaccurate(truth, scene, random, parameters)
    for relative, part in enumerate((None, f"{entry.handedness} hand")):
        keyframes = [
            Keyframe(
                frame=frame,
                time_ns=int(scene.times_ns[frame]),
                camera_from_object=pose_message(*pose),
                relative_to=part,
            )
            for frame, pose in placed.items()
        ]
        way = interpolate(keyframes, scene.times_ns, scene.joints, shape.symmetries)
        between = np.isfinite(way.translations[:, 0])
        between[list(placed)] = False
        nothing = np.full(len(frames), np.nan)
        plain = Track(way.translations, way.rotations)
        yield KINDS[relative], _errors(gauge, plain, truth, (nothing, visible), between)
        found = assist(scene, keyframes, way, (shape, viewpoints))
        refined = Track(found.labels.translations, found.labels.rotations)
        yield (
            KINDS[2 + relative],
            _errors(gauge, refined, truth, (found.doubts, visible), between),
        )


def _visible(entry: DatasetEntry, frames: list[RecordedFrame]) -> Array:
    """Return the share of the object that is visible in each frame (T,); raises DatasetError."""
    shares = [None if one.label is None else one.label.visible_fraction for one in frames]
    if None in shares:
        raise DatasetError(
            f"{entry.file} does not say how much of its object is visible: give a dataset of "
            "`inhand simulate` with images"
        )
    return np.array(shares, float)


def _inaccurate(
    truth: Track, scene: Scene, random: np.random.Generator, parameters: LabelCheckParameters
) -> dict[int, tuple[Array, Array]]:
    """Return keyframes by frame: true poses, exactly a person's inaccuracy off."""
    last = len(scene.frames) - 1
    placed = {}
    for frame in sorted({*range(0, last, parameters.every), last}):
        shift, axis = (one / np.linalg.norm(one) for one in random.standard_normal((2, 3)))
        turn = rotations.from_vector(parameters.keyframe_rad * axis)
        placed[frame] = (
            truth.translations[frame] + parameters.keyframe_m * shift,
            rotations.multiply(turn, truth.rotations[frame]),
        )
    return placed


def _errors(
    gauge: ErrorGauge, found: Track, truth: Track, told: tuple[Array, Array], between: Flags
) -> _Measured:
    errors = gauge.compare(found.of(between), truth.of(between))
    return _Measured(
        1e3 * errors.translation_m,
        np.rad2deg(errors.rotation_rad),
        told[0][between],
        told[1][between],
    )


def _check(
    interaction: str, measured: dict[str, list[_Measured]], parameters: LabelCheckParameters
) -> LabelCheck:
    rows: dict[bool, list[LabelErrors]] = {True: [], False: []}
    for kind, some in measured.items():
        millimetres, degrees, doubts, visible = (
            np.concatenate([getattr(one, name) for one in some])
            for name in ("translation_mm", "rotation_deg", "doubts", "visible")
        )
        for seen, row in rows.items():
            chosen = (visible >= parameters.visible_share) == seen
            row.append(_summary(kind, millimetres[chosen], degrees[chosen], doubts[chosen]))
    return LabelCheck(interaction, tuple(rows[True]), tuple(rows[False]))


def _summary(kind: str, millimetres: Array, degrees: Array, doubts: Array) -> LabelErrors:
    if not len(millimetres):
        return LabelErrors(kind, 0)
    told = np.isfinite(doubts).all() and np.ptp(doubts) > 0.0 and np.ptp(millimetres) > 0.0
    return LabelErrors(
        kind,
        len(millimetres),
        float(np.median(millimetres)),
        float(np.median(degrees)),
        _rank_correlation(doubts, millimetres) if told else None,
    )


def _rank_correlation(first: Array, second: Array) -> float:
    """Return Spearman's correlation of two series (N,)."""
    ranks = [np.argsort(np.argsort(one)).astype(float) for one in (first, second)]
    return float(np.corrcoef(ranks)[0, 1])

"""Measures how far labels between keyframes are from the truth, in a simulated dataset.

Keyframes are the truth with a person's inaccuracy; only the frames between them are measured.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.viewpoints import Viewpoints, find_viewpoints
from inhand_tracker.wire.poses import pose_message

from inhand_lab.benchmarks.parameters import DEFAULT_LABEL_CHECK, LabelCheckParameters
from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.recorded_frames import RecordedFrame, labelled_camera, load_frames
from inhand_lab.datasets.tracks import Track, true_track
from inhand_lab.evaluation.pose_errors import ErrorGauge
from inhand_lab.labelling.assisted_labels import assist
from inhand_lab.labelling.equal_poses import Pose
from inhand_lab.labelling.interpolation import interpolate
from inhand_lab.labelling.keyframes import Keyframe
from inhand_lab.labelling.scene import Scene, load_scene

KINDS = ("plain", "hand", "assisted", "both")
"""Names of how labels are made: interpolated in the camera's frame, or relative to the hand that a
person prefers; and the same two refined by the images."""
_BY_HAND, _BY_IMAGES = KINDS[1::2], KINDS[2:]

COUNTED_KINDS = KINDS[:3]
"""Those of which it is found how many keyframes they need."""


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
class KeyframesNeeded:
    """The most frames from one keyframe to the next with which a kind of labels reaches the aims,
    and with which it reaches those in place, without those in turn; None where none of those tried
    does. ``keyframes`` and ``keyframes_for_place`` are how many these are in a recording."""

    kind: str
    every: int | None
    keyframes: int | None
    every_for_place: int | None
    keyframes_for_place: int | None


@dataclass(frozen=True)
class LabelCheck:
    """An interaction's errors by ``KINDS``: of frames in which at least a third of the object is
    ``visible``, and of the others, ``hidden``; and the keyframes ``needed`` by
    ``COUNTED_KINDS``."""

    interaction: str
    visible: tuple[LabelErrors, ...]
    hidden: tuple[LabelErrors, ...]
    needed: tuple[KeyframesNeeded, ...] = ()


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
        seen, gauge = (shape, find_viewpoints(shape)), ErrorGauge(shape)
        measured: dict[int, dict[str, list[_Measured]]] = {}
        frames = 0
        for number, entry in enumerate(entries):
            recording = _Labelled.of(dataset, entry, gauge)
            frames = len(recording.visible)
            for every in dict.fromkeys((parameters.every, *parameters.spacings)):
                random = np.random.default_rng((parameters.seed, number))
                placed = recording.inaccurate(every, random, parameters)
                kinds = KINDS if every == parameters.every else COUNTED_KINDS
                for kind in kinds:
                    errors = recording.errors(kind, placed, seen)
                    measured.setdefault(every, {}).setdefault(kind, []).append(errors)
            on_recording()
        yield _check(interaction, measured, frames, parameters)


@dataclass(frozen=True)
class _Labelled:
    """A recording with its truth, the share of the object that is ``visible`` in each frame (T,),
    and the hand that the person prefers."""

    scene: Scene
    truth: Track
    gauge: ErrorGauge
    visible: Array
    hand: str

    @classmethod
    def of(cls, dataset: Dataset, entry: DatasetEntry, gauge: ErrorGauge) -> "_Labelled":
        """Read a recording of a dataset."""
        path = dataset.path(entry)
        frames = load_frames(path, entry.object, entry.camera)
        scene = load_scene(path, labelled_camera(frames) or "camera")
        hand = f"{entry.handedness} hand"
        return cls(scene, true_track(frames), gauge, _visible(entry, frames), hand)

    def inaccurate(
        self, every: int, random: np.random.Generator, parameters: LabelCheckParameters
    ) -> dict[int, Pose]:
        """Return keyframes by frame: true poses, exactly a person's inaccuracy off."""
        last = len(self.visible) - 1
        placed = {}
        for frame in keyframes_of(last, every):
            shift, axis = (one / np.linalg.norm(one) for one in random.standard_normal((2, 3)))
            turn = rotations.from_vector(parameters.keyframe_rad * axis)
            placed[frame] = (
                self.truth.translations[frame] + parameters.keyframe_m * shift,
                rotations.multiply(turn, self.truth.rotations[frame]),
            )
        return placed

    def errors(
        self, kind: str, placed: dict[int, Pose], seen: tuple[ObjectShape, Viewpoints]
    ) -> _Measured:
        """Label in one way, and measure the frames between keyframes."""
        keyframes = [
            Keyframe(
                frame=frame,
                time_ns=int(self.scene.times_ns[frame]),
                camera_from_object=pose_message(*pose),
                relative_to=self.hand if kind in _BY_HAND else None,
            )
            for frame, pose in placed.items()
        ]
        scene = self.scene
        way = interpolate(keyframes, scene.times_ns, scene.joints, seen[0].symmetries)
        between = np.isfinite(way.translations[:, 0])
        between[list(placed)] = False
        labels, doubts = Track(way.translations, way.rotations), np.full(len(between), np.nan)
        if kind in _BY_IMAGES:
            found = assist(scene, keyframes, way, seen)
            labels, doubts = Track(found.labels.translations, found.labels.rotations), found.doubts
        errors = self.gauge.compare(labels.of(between), self.truth.of(between))
        return _Measured(
            1e3 * errors.translation_m,
            np.rad2deg(errors.rotation_rad),
            doubts[between],
            self.visible[between],
        )


def keyframes_of(last: int, every: int) -> list[int]:
    """Return the frames that get keyframes: one in so many, and the ``last``."""
    return sorted({*range(0, last, every), last})


def _visible(entry: DatasetEntry, frames: list[RecordedFrame]) -> Array:
    """Return the share of the object that is visible in each frame (T,); raises DatasetError."""
    shares = [None if one.label is None else one.label.visible_fraction for one in frames]
    if None in shares:
        raise DatasetError(
            f"{entry.file} does not say how much of its object is visible: give a dataset of "
            "`inhand simulate` with images"
        )
    return np.array(shares, float)


def _check(
    interaction: str,
    measured: dict[int, dict[str, list[_Measured]]],
    frames: int,
    parameters: LabelCheckParameters,
) -> LabelCheck:
    """Sum up an interaction, measured by frames between keyframes and by kind."""
    errors = {every: _both(kinds, parameters) for every, kinds in measured.items()}
    place_alone = replace(parameters, visible_aim_deg=np.inf, hidden_aim_deg=np.inf)
    needed = []
    for index, kind in enumerate(COUNTED_KINDS):
        found: list[int | None] = []
        for aims in (parameters, place_alone):
            enough = [
                every
                for every in parameters.spacings
                if reaches_aims(errors[every][0][index], errors[every][1][index], aims)
            ]
            every = max(enough, default=None)
            count = None if every is None else len(keyframes_of(frames - 1, every))
            found += [every, count]
        needed.append(KeyframesNeeded(kind, *found))
    return LabelCheck(interaction, *errors[parameters.every], tuple(needed))


def reaches_aims(
    visible: LabelErrors, hidden: LabelErrors, parameters: LabelCheckParameters
) -> bool:
    """Return whether errors are small enough, where the object is visible and where it is not;
    where there are no frames nothing is asked."""
    aims = (
        (visible, parameters.visible_aim_mm, parameters.visible_aim_deg),
        (hidden, parameters.hidden_aim_mm, parameters.hidden_aim_deg),
    )
    return all(
        one.translation_mm is None
        or one.rotation_deg is None
        or (one.translation_mm <= millimetres and one.rotation_deg <= degrees)
        for one, millimetres, degrees in aims
    )


def _both(
    kinds: dict[str, list[_Measured]], parameters: LabelCheckParameters
) -> tuple[tuple[LabelErrors, ...], tuple[LabelErrors, ...]]:
    """Return the errors of each kind where the object is visible, and where it is not."""
    rows: dict[bool, list[LabelErrors]] = {True: [], False: []}
    for kind, some in kinds.items():
        millimetres, degrees, doubts, visible = (
            np.concatenate([getattr(one, name) for one in some])
            for name in ("translation_mm", "rotation_deg", "doubts", "visible")
        )
        for seen, row in rows.items():
            chosen = (visible >= parameters.visible_share) == seen
            row.append(_summary(kind, millimetres[chosen], degrees[chosen], doubts[chosen]))
    return tuple(rows[True]), tuple(rows[False])


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

"""What each part of ``fusion`` is worth: each taken out once, all on the same frames.

What another value of a parameter is worth is found in the same way (``variation``). People are left
out one at a time, or the recordings of another dataset are tested: so it shows what makes a model
of simulated people true for real ones.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from inhand_tracker.body.anchors import ANCHORS
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.methods.fusion.parameters import DEFAULT_FUSION, FusionParameters
from inhand_tracker.methods.fusion.tracker import FusionTracker
from inhand_tracker.methods.registry import FUSION, METHODS
from inhand_tracker.model.model import Model
from inhand_tracker.prior.prior import Prior
from inhand_tracker.sight.sight import SIGHT_TERMS, SightTerm

from inhand_lab.benchmarks.ablation_data import (
    AblationData,
    learn_from_plain_people,
    learn_usually,
)
from inhand_lab.benchmarks.variation import vary
from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.observations import track_together
from inhand_lab.datasets.recorded_frames import RecordedFrame
from inhand_lab.datasets.stretches import entry_frames
from inhand_lab.datasets.tracks import Track
from inhand_lab.evaluation.folds import Fold
from inhand_lab.evaluation.pose_errors import ErrorGauge
from inhand_lab.evaluation.scoring import Judge
from inhand_lab.workers import in_processes

NOT_TRUSTED = 1e6
"""Squared error, in m², of a prediction that is taken out: its weight is nothing."""
WITH_IMAGES_ONLY = ("likelihood", "search")
"""Parts that make no difference where no image is looked at."""


@dataclass(frozen=True)
class FusionVariant:
    """``fusion`` with something taken out, or ``instead`` of it something else.

    Where it does not map (``maps``), skeletons are taken as if they were of the model's convention.
    """

    part: str
    without: str
    instead: str = ""
    parameters: FusionParameters = DEFAULT_FUSION
    terms: tuple[SightTerm, ...] = SIGHT_TERMS
    changed: Callable[[Prior], Prior] = lambda prior: prior
    learn: Callable[[AblationData, Fold], Model] = learn_usually
    maps: bool = True

    def tracker(self, model: Model, *, left_handed: bool) -> FusionTracker:
        """A tracker of that kind; raises DatasetError for a model without a prior."""
        if model.prior is None:
            raise DatasetError(f"the model of {model.shape.name} holds no prior")
        return FusionTracker(
            replace(model, prior=self.changed(model.prior)),
            left_handed=left_handed,
            terms=self.terms,
            parameters=self.parameters,
        )


def _only(views: tuple[int, ...], anchors: tuple[str, ...]) -> Callable[[Prior], Prior]:
    """A prior in which nothing but these predictions counts."""

    def restricted(prior: Prior) -> Prior:
        dropped = np.array(
            [
                view not in views or anchor not in anchors
                for view in range(len(prior.regressions))
                for anchor in ANCHORS
            ]
        )
        doubt = (NOT_TRUSTED * np.diag(dropped)).astype(np.float32)
        return replace(
            prior,
            translation_products=prior.translation_products + doubt,
            rotation_products=prior.rotation_products + doubt,
        )

    return restricted


def _equally_weighted(prior: Prior) -> Prior:
    equal = np.broadcast_to(
        np.eye(prior.translation_products.shape[-1], dtype=np.float32),
        prior.translation_products.shape,
    )
    return replace(prior, translation_products=equal, rotation_products=equal)


VARIANTS: tuple[FusionVariant, ...] = (
    FusionVariant("", "nothing"),
    FusionVariant("prior", "all anchors but the trunk", changed=_only((0, 1, 2), ("trunk",))),
    FusionVariant("prior", "all anchors but the hand", changed=_only((0, 1, 2), ("right hand",))),
    FusionVariant("prior", "memory", changed=_only((0, 1), ANCHORS)),
    FusionVariant("prior", "memory, and the upper body by itself", changed=_only((0,), ANCHORS)),
    FusionVariant("prior", "weights by how well each predicts", changed=_equally_weighted),
    *(
        FusionVariant("likelihood", term, terms=tuple(one for one in SIGHT_TERMS if one != term))
        for term in SIGHT_TERMS
    ),
    FusionVariant("likelihood", "all of it", terms=()),
    FusionVariant(
        "search", "what was seen before", parameters=replace(DEFAULT_FUSION, carries=False)
    ),
    FusionVariant(
        "search", "an object that was left", parameters=replace(DEFAULT_FUSION, leaves=False)
    ),
    FusionVariant("search", "refinement", parameters=replace(DEFAULT_FUSION, refines=False)),
)


def _without_hold(prior: Prior) -> Prior:
    return replace(prior, hold=None)


TRANSFER: tuple[FusionVariant, ...] = (
    FusionVariant("transfer", "how the object is held", changed=_without_hold),
    FusionVariant(
        "transfer",
        "a covariance that grows far from home",
        parameters=replace(
            DEFAULT_FUSION,
            prior=replace(DEFAULT_FUSION.prior, most_stretched=1.0, held_doubt=0.0),
        ),
    ),
    FusionVariant("transfer", "the canonical body", maps=False),
    FusionVariant("transfer", "people's variety", learn=learn_from_plain_people),
)
"""What makes models true for people of another kind than those who taught."""


def varied(settings: Sequence[str]) -> tuple[FusionVariant, ...]:
    """Fusion as it is, and with each ``FIELD=VALUE`` by itself; raises SettingsError."""
    variants = [VARIANTS[0]]
    for setting in settings:
        parameters, usual = vary(setting)
        variants.append(FusionVariant("parameter", usual, setting, parameters))
    return tuple(variants)


@dataclass(frozen=True)
class Worth:
    """A variant's means over interactions: the vertex error in cm, and the percentage of poses
    whose 90 % region holds the truth, NaN where no pose has a region."""

    variant: FusionVariant
    vertex_error_cm: float
    region_percent: float


def ablate(
    data: AblationData,
    processes: int,
    on_progress: Callable[[], None] = lambda: None,
    settings: Sequence[str] = (),
) -> list[Worth]:
    """Try every variant on every fold; ``on_progress`` is called once a fold.

    The variants are all parts that count with this data, or, where there are ``settings``, what
    those make of fusion. Raises DatasetError, RecordingError or SettingsError.
    """
    folds = data.folds()
    tasks = [(data, fold, settings) for fold in folds]
    figures = in_processes(_try_fold, tasks, processes, lambda _: on_progress())
    by_interaction: dict[str, list[Array]] = {}
    for fold, of_fold in zip(folds, figures, strict=True):
        by_interaction.setdefault(fold.interaction, []).append(of_fold)
    means = np.mean([np.mean(cell, axis=0) for cell in by_interaction.values()], axis=0)
    return [
        Worth(one, 100.0 * float(error), 100.0 * float(region))
        for one, (error, region) in zip(variants_for(data, settings), means, strict=True)
    ]


def variants_for(data: AblationData, settings: Sequence[str] = ()) -> tuple[FusionVariant, ...]:
    """Choose what is compared on some data; raises SettingsError."""
    if settings:
        return varied(settings)
    return tuple(
        variant
        for variant in (*VARIANTS, *TRANSFER)
        if (data.images or variant.part not in WITH_IMAGES_ONLY)
        and (data.plain is not None or variant.learn is not learn_from_plain_people)
        and (data.tested is not None or variant.maps)
    )


def _try_fold(task: tuple[AblationData, Fold, Sequence[str]]) -> Array:
    """The vertex error of each variant in metres, and its region's share, (V, 2)."""
    data, fold, settings = task
    variants = variants_for(data, settings)
    models = {learn: learn(data, fold) for learn in {variant.learn for variant in variants}}
    trackers = [(variant, models[variant.learn]) for variant in variants]
    tested = data.trained if data.tested is None else data.tested
    figures = [list(_figures(tested, entry, trackers)) for entry in fold.tested]
    return np.mean(figures, axis=0)


def _figures(
    dataset: Dataset, entry: DatasetEntry, variants: Sequence[tuple[FusionVariant, Model]]
) -> Iterator[tuple[float, float]]:
    """The vertex error of each variant in one recording, in metres, and its region's share."""
    path = dataset.path(entry)
    frames = entry_frames(dataset, entry)
    joints, tracks = _track_variants(path, frames, variants, left_handed=entry.handedness == "left")
    judge = Judge(frames, joints, ErrorGauge(variants[0][1].shape))
    for track in tracks:
        score = judge.score(track)
        if score is None:
            raise DatasetError(f"{entry.file}: no frame has both a pose and a label")
        yield score.vertex_error_m, np.nan if score.region_share is None else score.region_share


def _track_variants(
    path: Path,
    frames: Sequence[RecordedFrame],
    variants: Sequence[tuple[FusionVariant, Model]],
    *,
    left_handed: bool,
) -> tuple[Array, list[Track]]:
    """The joints (T, 20, 3) of a recording, and each track; bodies are read once for variants
    that map joints, and once for those that do not."""
    needs = METHODS[FUSION].needs(SIGHT_TERMS)
    tracks: dict[int, Track] = {}
    for maps in (False, True):
        numbers = [n for n, (variant, _) in enumerate(variants) if variant.maps is maps]
        if not numbers:
            continue
        chosen = [variants[number] for number in numbers]
        shown = frames
        if not maps:
            learned_as = chosen[0][1].mapping.convention
            shown = [replace(frame, convention=learned_as) for frame in frames]
        trackers = [variant.tracker(model, left_handed=left_handed) for variant, model in chosen]
        joints, some = track_together(trackers, path, shown, needs)
        tracks |= dict(zip(numbers, some, strict=True))
    return joints, [tracks[number] for number in range(len(variants))]

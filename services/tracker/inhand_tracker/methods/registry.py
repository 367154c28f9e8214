"""Every method by name.

To add one: give it a package, its name in ``MethodName``, and a record in ``METHODS``.
"""

from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from functools import partial
from typing import Literal, get_args

from inhand_runtime.errors import SettingsError

from inhand_tracker.methods.darby2014.parameters import DEFAULT_DARBY2014
from inhand_tracker.methods.darby2014.terms import DEFAULT_TERMS, TERMS
from inhand_tracker.methods.darby2014.variants import VARIANTS, PublishedMethod, Variant
from inhand_tracker.methods.fusion.parameters import DEFAULT_FUSION
from inhand_tracker.methods.fusion.tracker import FusionTracker
from inhand_tracker.methods.object_tracker import ObjectTracker
from inhand_tracker.model.model import Model
from inhand_tracker.sight.sight import SIGHT_TERMS
from inhand_tracker.wire.conversion import Need

MethodName = Literal["fusion"] | PublishedMethod
FUSION: MethodName = "fusion"
DEFAULT_METHOD = FUSION

AnyTerm = Literal["edges", "region", "interior", "depth"]
ALL_TERMS: tuple[AnyTerm, ...] = get_args(AnyTerm)


@dataclass(frozen=True)
class TrackerOptions:
    """What a tracker is made with beside its model; ``particles`` is the method's own where
    None. It may get images of ``several_cameras``."""

    left_handed: bool
    terms: tuple[AnyTerm, ...]
    particles: int | None
    seed: int
    several_cameras: bool = False


@dataclass(frozen=True)
class Method:
    """How a method is made, and what it asks for."""

    name: MethodName
    terms: tuple[AnyTerm, ...]
    """Terms of an image's likelihood that it can weigh."""
    usual_terms: tuple[AnyTerm, ...]
    """Terms that it weighs where nobody chose."""
    needs: Callable[[Collection[AnyTerm]], tuple[Need, ...]]
    """What of a frame must be decoded for some terms."""
    new: Callable[[Model, TrackerOptions], ObjectTracker]
    """Makes a tracker."""
    learns_prior: bool
    """Whether its models hold a prior."""


def _new_fusion(model: Model, options: TrackerOptions) -> ObjectTracker:
    hypotheses = options.particles or DEFAULT_FUSION.hypotheses
    return FusionTracker(
        model,
        left_handed=options.left_handed,
        terms=[term for term in SIGHT_TERMS if term in options.terms],
        parameters=replace(DEFAULT_FUSION, hypotheses=hypotheses),
        seed=options.seed,
        several_cameras=options.several_cameras,
    )


def _new_published(variant: Variant, model: Model, options: TrackerOptions) -> ObjectTracker:
    # It needs the extra ``lab``, which fusion does not.
    from inhand_tracker.methods.darby2014.tracker import ParticleTracker

    particles = options.particles or DEFAULT_DARBY2014.particles
    return ParticleTracker(
        model,
        variant,
        left_handed=options.left_handed,
        terms=[term for term in TERMS if term in options.terms],
        parameters=replace(DEFAULT_DARBY2014, particles=particles),
        seed=options.seed,
    )


def _pixels_of_sight(terms: Collection[AnyTerm]) -> tuple[Need, ...]:
    return ("colour", "depth") if terms else ()


def _published_terms(terms: Collection[AnyTerm]) -> tuple[Need, ...]:
    return tuple(term for term in TERMS if term in terms)


def _published(variant: Variant) -> Method:
    return Method(
        name=variant.name,
        terms=TERMS,
        usual_terms=DEFAULT_TERMS,
        needs=_published_terms,
        new=partial(_new_published, variant),
        learns_prior=False,
    )


METHODS: dict[str, Method] = {
    method.name: method
    for method in (
        Method(
            name=FUSION,
            terms=SIGHT_TERMS,
            usual_terms=SIGHT_TERMS,
            needs=_pixels_of_sight,
            new=_new_fusion,
            learns_prior=True,
        ),
        *(_published(variant) for variant in VARIANTS.values()),
    )
}


def new_tracker(
    model: Model,
    method: MethodName = DEFAULT_METHOD,
    *,
    left_handed: bool = False,
    terms: Collection[AnyTerm] | None = None,
    particles: int | None = None,
    seed: int = 0,
    several_cameras: bool = False,
) -> ObjectTracker:
    """A tracker for one object; ``terms`` and ``particles`` are the method's own where None. It is
    ready for images of ``several_cameras`` where it may get such.

    Raises SettingsError for terms that the method does not know, and ModelError for a model that
    it cannot use.
    """
    chosen = METHODS[method]
    terms = chosen.usual_terms if terms is None else terms
    if unknown := [term for term in terms if term not in chosen.terms]:
        raise SettingsError(
            f"{method} does not weigh {unknown[0]!r}; it knows: {', '.join(chosen.terms)}"
        )
    options = TrackerOptions(left_handed, tuple(terms), particles, seed, several_cameras)
    return chosen.new(model, options)

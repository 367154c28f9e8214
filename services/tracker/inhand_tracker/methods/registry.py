"""Every method by name. To add one: give it a package, and a record in ``METHODS``."""

from collections.abc import Callable, Collection
from dataclasses import dataclass
from functools import partial
from typing import Literal, get_args

from inhand_runtime.errors import SettingsError

from inhand_tracker.methods.darby2014.likelihood import DEFAULT_TERMS, TERMS
from inhand_tracker.methods.darby2014.tracker import PARTICLES, ParticleTracker
from inhand_tracker.methods.darby2014.variants import VARIANTS, PublishedMethod
from inhand_tracker.methods.fusion.search import Search
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
    """What a tracker is told beside its model: ``particles`` is the method's own where None."""

    left_handed: bool
    terms: tuple[AnyTerm, ...]
    particles: int | None
    seed: int


@dataclass(frozen=True)
class Method:
    """How a method is made, and what it asks for.

    ``terms`` of an image may weigh in it, ``usual_terms`` weigh where nobody chose; ``needs`` says
    what of a frame must be decoded for terms; ``learns_prior`` whether its models hold a prior.
    """

    name: MethodName
    terms: tuple[AnyTerm, ...]
    usual_terms: tuple[AnyTerm, ...]
    needs: Callable[[Collection[AnyTerm]], tuple[Need, ...]]
    new: Callable[[Model, TrackerOptions], ObjectTracker]
    learns_prior: bool


def _new_fusion(model: Model, options: TrackerOptions) -> ObjectTracker:
    return FusionTracker(
        model,
        left_handed=options.left_handed,
        terms=[term for term in SIGHT_TERMS if term in options.terms],
        search=Search() if options.particles is None else Search(hypotheses=options.particles),
        seed=options.seed,
    )


def _new_published(name: str, model: Model, options: TrackerOptions) -> ObjectTracker:
    return ParticleTracker(
        model,
        VARIANTS[name],
        left_handed=options.left_handed,
        terms=[term for term in TERMS if term in options.terms],
        particles=options.particles or PARTICLES,
        seed=options.seed,
    )


def _pixels_of_sight(terms: Collection[AnyTerm]) -> tuple[Need, ...]:
    return ("colour", "depth") if terms else ()


def _published_terms(terms: Collection[AnyTerm]) -> tuple[Need, ...]:
    return tuple(term for term in TERMS if term in terms)


METHODS: dict[str, Method] = {
    FUSION: Method(
        FUSION, SIGHT_TERMS, SIGHT_TERMS, _pixels_of_sight, _new_fusion, learns_prior=True
    ),
    **{
        name: Method(
            name,
            TERMS,
            DEFAULT_TERMS,
            _published_terms,
            partial(_new_published, name),
            learns_prior=False,
        )
        for name in get_args(PublishedMethod)
    },
}


def new_tracker(
    model: Model,
    method: MethodName,
    *,
    left_handed: bool = False,
    terms: Collection[AnyTerm] | None = None,
    particles: int | None = None,
    seed: int = 0,
) -> ObjectTracker:
    """A tracker for one object; ``terms`` and ``particles`` are the method's own where None.

    Raises SettingsError for terms that the method does not know, and ModelError for a model that
    it cannot use.
    """
    chosen = METHODS[method]
    terms = chosen.usual_terms if terms is None else terms
    if unknown := [term for term in terms if term not in chosen.terms]:
        raise SettingsError(
            f"{method} does not weigh {unknown[0]!r}; it knows: {', '.join(chosen.terms)}"
        )
    return chosen.new(model, TrackerOptions(left_handed, tuple(terms), particles, seed))

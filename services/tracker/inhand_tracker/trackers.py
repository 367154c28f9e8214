"""Every method's tracker by name: the published ones', and fusion."""

from collections.abc import Collection
from typing import Literal, Protocol, get_args

import numpy as np
from inhand_runtime.errors import SettingsError
from numpy.typing import NDArray

from inhand_tracker.body_reader import Body, BodyReader
from inhand_tracker.camera import Intrinsics
from inhand_tracker.conversion import Need
from inhand_tracker.estimate import Estimate
from inhand_tracker.fusion import FusionTracker
from inhand_tracker.fusion_search import Search
from inhand_tracker.image import Image
from inhand_tracker.likelihood import DEFAULT_TERMS, TERMS
from inhand_tracker.methods import METHODS, PublishedMethod
from inhand_tracker.model_file import Model
from inhand_tracker.presence import Support
from inhand_tracker.sight import SIGHT_TERMS
from inhand_tracker.tracking import PARTICLES, Tracker

Array = NDArray[np.float64]

MethodName = Literal["fusion"] | PublishedMethod
FUSION: MethodName = "fusion"
DEFAULT_METHOD = FUSION
ALL_METHODS: tuple[MethodName, ...] = (FUSION, *get_args(PublishedMethod))

AnyTerm = Literal["edges", "region", "interior", "depth"]
ALL_TERMS: tuple[AnyTerm, ...] = get_args(AnyTerm)


class ObjectTracker(Protocol):
    """Follows one object of one person through the frames of one camera."""

    @property
    def support(self) -> Support | None:
        """What the last image says for the object; None where it says nothing."""

    def restart(self) -> None:
        """Forget the person and the object: somebody else comes into view."""

    def new_reader(self) -> BodyReader:
        """A reader of bodies for trackers of this model and handedness."""

    def step(self, joints: Array | None, time_ns: int, image: Image | None = None) -> Estimate:
        """One frame: the person's joints (20, 3) in the camera frame, or None, and an image."""

    def step_body(self, body: Body | None, time_ns: int, image: Image | None = None) -> Estimate:
        """One frame, as ``step``, of a body that a reader of ``new_reader`` has read."""

    def remember(self, body: Body, time_ns: int) -> None:
        """A frame in which the object is not looked for; what the body did before counts later."""

    def estimate_single_frame(self, joints: Array, image: Image | None = None) -> Estimate:
        """The object's pose in a frame by itself; what is tracked is neither used nor changed."""

    def outline(self, estimate: Estimate, camera: Intrinsics) -> Array | None:
        """Pixels (B, 2) of the boundary of the object at an estimate; None for a lost one."""


def terms_of(method: MethodName) -> tuple[AnyTerm, ...]:
    """What of an image may weigh in a method."""
    return SIGHT_TERMS if method == FUSION else TERMS


def usual_terms(method: MethodName) -> tuple[AnyTerm, ...]:
    """What of an image weighs in a method where nobody chose."""
    return SIGHT_TERMS if method == FUSION else DEFAULT_TERMS


def needs_of(method: MethodName, terms: Collection[AnyTerm]) -> tuple[Need, ...]:
    """What of a frame must be decoded for that."""
    if method == FUSION:
        return ("colour", "depth") if terms else ()
    return tuple(term for term in TERMS if term in terms)


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
    if terms is None:
        terms = usual_terms(method)
    if unknown := [term for term in terms if term not in terms_of(method)]:
        raise SettingsError(
            f"{method} does not weigh {unknown[0]!r}; it knows: {', '.join(terms_of(method))}"
        )
    if method == FUSION:
        return FusionTracker(
            model,
            left_handed=left_handed,
            terms=terms,
            search=Search() if particles is None else Search(hypotheses=particles),
            seed=seed,
        )
    return Tracker(
        model,
        METHODS[method],
        left_handed=left_handed,
        terms=[term for term in TERMS if term in terms],
        particles=particles or PARTICLES,
        seed=seed,
    )

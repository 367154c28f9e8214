"""Labels of a whole recording, refined by its images, with a doubt for each frame."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.viewpoints import Viewpoints
from inhand_tracker.sight.appearance import Appearance, AppearanceSample, learn_appearance
from inhand_tracker.sight.parameters import DEFAULT_SIGHT
from inhand_tracker.sight.sight import Sight

from inhand_lab.datasets.frame_index import FrameIndex, open_frames
from inhand_lab.labelling.assistance import Assisted, Shown, StretchRefiner
from inhand_lab.labelling.interpolation import Interpolated, Stretch
from inhand_lab.labelling.keyframes import Keyframe, LabellingError
from inhand_lab.labelling.labelled_copy import Labels
from inhand_lab.labelling.looking import Looker
from inhand_lab.labelling.parameters import DEFAULT_LABELLING, LabellingParameters
from inhand_lab.labelling.scene import Scene
from inhand_lab.labelling.smoothing import Way
from inhand_lab.labelling.stretch_views import StretchViews, image_at


@dataclass(frozen=True)
class AssistedLabels:
    """Labels, and the ``doubts`` (T,) in metres: how far the surface of the object may be off where
    it is labelled. It is NaN in frames without a pose, and 0 in keyframes."""

    labels: Labels
    doubts: Array

    @property
    def worst_frame(self) -> int | None:
        """The frame with the greatest doubt; None where none has any."""
        if not np.isfinite(self.doubts).any():
            return None
        return int(np.nanargmax(self.doubts))


def assist(
    scene: Scene,
    keyframes: Sequence[Keyframe],
    way: Interpolated,
    seen: tuple[ObjectShape, Viewpoints],
    parameters: LabellingParameters = DEFAULT_LABELLING,
    on_stretch: Callable[[], None] = lambda: None,
) -> AssistedLabels:
    """Refine interpolated labels by the images; the keyframes' own frames keep their poses.

    The object's colours are learned from the keyframes. ``on_stretch`` is called after each stretch
    between two keyframes. Raises RecordingError, and LabellingError
    where no keyframe's frame has depth.
    """
    shape, viewpoints = seen
    translations, turns = way.translations.copy(), way.rotations.copy()
    covariances = np.full((len(translations), 6, 6), np.nan)
    doubts = np.where(np.isfinite(translations[:, 0]), 0.0, np.nan)
    radius = float(np.sqrt((shape.vertices**2).sum(axis=1).mean()))
    with open_frames(scene.path, scene.camera) as frames:
        learned = learn_appearance(shape, _samples(scene, frames, keyframes))
        sight, parameters = Sight(shape, viewpoints, learned), _fitting(parameters, learned)
        refiner = StretchRefiner(Looker(sight, parameters), parameters)
        for stretch in way.stretches:
            views = StretchViews(scene, frames, sight, stretch, parameters.views_kept)
            found = refiner.refine(_shown(scene, way, stretch, views))
            inner, kept = stretch.inner, slice(1, -1)
            translations[inner] = found.way.translations[kept]
            turns[inner] = found.way.rotations[kept]
            covariances[inner] = found.covariances[kept]
            doubts[inner] = doubt(found, radius)[kept]
            on_stretch()
    return AssistedLabels(Labels(translations, turns, way.absent, covariances), doubts)


def _fitting(parameters: LabellingParameters, learned: Appearance | None) -> LabellingParameters:
    """Return the parameters for an object that was learned to look so."""
    if learned is None or learned.returned >= DEFAULT_SIGHT.least_returned:
        return parameters
    return replace(parameters, sight_share=parameters.unmeasured_sight_share)


def doubt(found: Assisted, radius: float) -> Array:
    """Return how far (T,), in metres, an object's surface may be off, ``radius`` from its origin.

    It is the root mean square by the covariance, times the disagreement of both directions where
    they disagree.
    """
    variances = np.diagonal(found.covariances, axis1=1, axis2=2)
    # A turn about a random axis moves a point by the radius times √(2/3) of the angle.
    square = variances[:, :3].sum(axis=1) + radius**2 * variances[:, 3:].sum(axis=1) * 2.0 / 3.0
    return np.asarray(np.sqrt(square) * np.maximum(found.disagreements, 1.0))


def _shown(scene: Scene, way: Interpolated, stretch: Stretch, views: StretchViews) -> Shown:
    whole = slice(stretch.first, stretch.last + 1)
    places = way.translations[whole]
    times_s = (scene.times_ns[whole] - scene.times_ns[stretch.first]) / 1e9
    pixels_per_m = scene.info.fx / np.maximum(places[:, 2], 0.1)
    return Shown(Way(places, way.rotations[whole], times_s), views, pixels_per_m)


def _samples(
    scene: Scene, frames: FrameIndex, keyframes: Sequence[Keyframe]
) -> Iterator[AppearanceSample]:
    """Yield the images of keyframes; raises LabellingError where none has depth."""
    seen = deep = False
    for one in keyframes:
        image = None if one.pose is None else image_at(scene, frames, one.frame)
        if image is None or one.pose is None:
            continue
        seen, deep = True, deep or image.depth is not None
        yield image, *one.pose, scene.joints[one.frame]
    if not deep:
        lacking = "depth" if seen else "pictures"
        raise LabellingError(
            f"{scene.path} holds no {lacking} of camera {scene.camera} at its keyframes, by which "
            "labels could be refined: leave --assisted out"
        )

"""Labels of a whole recording, refined by its images, with a doubt for each frame."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import RgbdFrame
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.image import Image
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.viewpoints import Viewpoints
from inhand_tracker.sight.appearance import AppearanceSample, learn_appearance
from inhand_tracker.sight.frame import prepare
from inhand_tracker.sight.sight import Sight
from inhand_tracker.sight.view import SightView
from inhand_tracker.wire.conversion import image_of

from inhand_lab.datasets.frame_pixels import pixels_of
from inhand_lab.labelling.assistance import Assisted, Shown, StretchRefiner
from inhand_lab.labelling.interpolation import Interpolated, Stretch
from inhand_lab.labelling.keyframes import Keyframe, LabellingError
from inhand_lab.labelling.labelled_copy import Labels
from inhand_lab.labelling.looking import Looker
from inhand_lab.labelling.parameters import DEFAULT_LABELLING, LabellingParameters
from inhand_lab.labelling.scene import Scene
from inhand_lab.labelling.smoothing import Way


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
    sight = Sight(shape, viewpoints, learn_appearance(shape, _samples(scene, keyframes)))
    refiner = StretchRefiner(Looker(sight, parameters), parameters)
    translations, turns = way.translations.copy(), way.rotations.copy()
    covariances = np.full((len(translations), 6, 6), np.nan)
    doubts = np.where(np.isfinite(translations[:, 0]), 0.0, np.nan)
    radius = float(np.sqrt((shape.vertices**2).sum(axis=1).mean()))
    for stretch, images in stretch_images(scene, way.stretches):
        found = refiner.refine(_shown(scene, way, stretch, images, sight))
        inner, kept = stretch.inner, slice(1, -1)
        translations[inner] = found.way.translations[kept]
        turns[inner] = found.way.rotations[kept]
        covariances[inner] = found.covariances[kept]
        doubts[inner] = doubt(found, radius)[kept]
        on_stretch()
    return AssistedLabels(Labels(translations, turns, way.absent, covariances), doubts)


def doubt(found: Assisted, radius: float) -> Array:
    """Return how far (T,), in metres, an object's surface may be off, ``radius`` from its origin.

    It is the root mean square by the covariance, times the disagreement of both directions where
    they disagree.
    """
    variances = np.diagonal(found.covariances, axis1=1, axis2=2)
    # A turn about a random axis moves a point by the radius times √(2/3) of the angle.
    square = variances[:, :3].sum(axis=1) + radius**2 * variances[:, 3:].sum(axis=1) * 2.0 / 3.0
    return np.asarray(np.sqrt(square) * np.maximum(found.disagreements, 1.0))


def _shown(
    scene: Scene, way: Interpolated, stretch: Stretch, images: Sequence[Image | None], sight: Sight
) -> Shown:
    whole = slice(stretch.first, stretch.last + 1)
    views: list[SightView | None] = [
        None if image is None else sight.view(prepare(image), sight.start(), joints)
        for image, joints in zip(images, scene.joints[whole], strict=True)
    ]
    places = way.translations[whole]
    times_s = (scene.times_ns[whole] - scene.times_ns[stretch.first]) / 1e9
    return Shown(
        Way(places, way.rotations[whole], times_s),
        views,
        scene.info.fx / np.maximum(places[:, 2], 0.1),
    )


def stretch_images(
    scene: Scene, stretches: Sequence[Stretch]
) -> Iterator[tuple[Stretch, list[Image | None]]]:
    """Yield stretches, in order, with the image of each of their frames.

    It is None where none was recorded, or it is damaged. Raises RecordingError.
    """
    pixels = pixels_of(scene.path, scene.frames, scene.camera)
    waiting = next(pixels, None)
    shared: tuple[int, Image | None] = (-1, None)
    for stretch in stretches:
        images: list[Image | None] = [None] * (stretch.last - stretch.first + 1)
        if shared[0] == stretch.first:
            images[0] = shared[1]
        while waiting is not None and waiting[0] <= stretch.last:
            if waiting[0] >= stretch.first:
                images[waiting[0] - stretch.first] = _image(scene, waiting[1])
            waiting = next(pixels, None)
        shared = stretch.last, images[-1]
        yield stretch, images


def _samples(scene: Scene, keyframes: Sequence[Keyframe]) -> Iterator[AppearanceSample]:
    """Yield the images of keyframes; raises LabellingError where none has depth."""
    poses = {one.frame: one.pose for one in keyframes}
    seen = deep = False
    for frame, pixels in pixels_of(scene.path, scene.frames, scene.camera):
        pose = poses.get(frame)
        image = None if pose is None else _image(scene, pixels)
        if image is None or pose is None:
            continue
        seen, deep = True, deep or image.depth is not None
        yield image, *pose, scene.joints[frame]
    if not deep:
        lacking = "depth" if seen else "pictures"
        raise LabellingError(
            f"{scene.path} holds no {lacking} of camera {scene.camera} at its keyframes, by which "
            "labels could be refined: leave --assisted out"
        )


def _image(scene: Scene, pixels: RgbdFrame) -> Image | None:
    with suppress(MessageError):
        return image_of(pixels, scene.info, ("colour", "depth"))
    return None

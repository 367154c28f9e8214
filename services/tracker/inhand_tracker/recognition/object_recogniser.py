"""Holds what all recognisers of objects do: read the body, and keep the last answer."""

from abc import ABC, abstractmethod

import numpy as np

from inhand_tracker.body.reader import Body, BodyReader, HasBodyPoses
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.image import Image
from inhand_tracker.recognition.recognition import Recognition


class ObjectRecogniser(ABC):
    """Recognises, frame by frame, which of K objects one person uses, and where it is.

    ``learned`` is what was learned from people, whose joints are of the convention ``learned_as``.
    ``convention`` names whose joints the next frames have, None where that is not said. A
    recogniser calls ``restart`` when it has made itself.
    """

    def __init__(
        self,
        learned: HasBodyPoses,
        objects: int,
        *,
        left_handed: bool,
        learned_as: str | None = None,
    ) -> None:
        self.convention: str | None = None
        self._learned_as = learned_as
        self._learned = learned
        self._objects = objects
        self._left_handed = left_handed

    def restart(self) -> None:
        """Forget the person and the object: somebody else comes into view."""
        self._reader = BodyReader(
            self._learned, left_handed=self._left_handed, convention=self._learned_as
        )
        self._last = Recognition(np.zeros(self._objects))

    def step(
        self,
        joints: Array | None,
        time_ns: int,
        image: Image | None = None,
        camera: Intrinsics | None = None,
    ) -> Recognition:
        """Recognise in one frame: the person's joints (20, 3) in the camera frame, and an image.

        Joints are None while nobody is seen. ``camera`` is for the box where there is no image.
        """
        body = None if joints is None else self._reader.read(joints, self.convention)
        if body is None:
            return self._without_body(time_ns, image)
        camera = camera if image is None else image.camera
        self._last = self._recognise(body, time_ns, image, camera)
        return self._last

    @property
    def trouble(self) -> str | None:
        """What is wrong with the convention of the joints; None where nothing is."""
        return self._reader.trouble

    @abstractmethod
    def _recognise(
        self, body: Body, time_ns: int, image: Image | None, camera: Intrinsics | None
    ) -> Recognition:
        """Recognise in a frame in which the body is seen."""

    @abstractmethod
    def _without_body(self, time_ns: int, image: Image | None) -> Recognition:
        """Give what stands of the last recognition while the body is not seen."""

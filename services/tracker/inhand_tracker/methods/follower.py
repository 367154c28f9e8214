"""What trackers of every method do alike: read bodies, age estimates, draw outlines.

A method gives its part as a ``Follower``: the estimate of one frame.
"""

from abc import ABC, abstractmethod

from inhand_tracker.body.reader import Body, BodyReader
from inhand_tracker.geometry.ageing import aged
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.considered import Considered
from inhand_tracker.geometry.estimate import LOST, Estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.model.model import Model
from inhand_tracker.shape.visible_points import VisiblePoints
from inhand_tracker.sight.support import Support


class Follower(ABC):
    """Follows one object of one person, from when they came into view.

    ``effort`` is the share of its usual work that the next estimate may take; ``convention`` names
    whose joints it gets. ``estimated`` says whether a body was seen in the last step.
    """

    def __init__(self, reader: BodyReader) -> None:
        self._reader = reader
        self._estimate = LOST
        self._time_ns = 0
        self._looked = False
        self.estimated = False
        self.effort = 1.0
        self.convention: str | None = None

    @property
    def trouble(self) -> str | None:
        """What is wrong with the convention of the joints; None where nothing is."""
        return self._reader.trouble

    @property
    def support(self) -> Support | None:
        """Support of the last step's image for the object; None where it shows nothing of it."""
        return None

    def considered(self) -> Considered | None:
        """What the last estimate was chosen from; None before the first, and of a method that
        chooses from nothing."""
        return None

    @abstractmethod
    def estimate(self, body: Body, time_ns: int, image: Image | None) -> Estimate:
        """Estimate the object's pose in a frame in which the body is seen."""

    def watch(self, time_ns: int, image: Image | None) -> Estimate | None:
        """Estimate the object's pose in a frame in which the body is not seen; None where its image
        does not show the object, and of a method that needs bodies."""
        return None

    @abstractmethod
    def remember(self, body: Body, time_ns: int) -> None:
        """Take a frame in which the object is not looked for."""

    def step(self, joints: Array | None, time_ns: int, image: Image | None) -> Estimate:
        body = None if joints is None else self._reader.read(joints, self.convention)
        return self.step_body(body, time_ns, image)

    def step_body(self, body: Body | None, time_ns: int, image: Image | None) -> Estimate:
        self._looked = False
        self.estimated = body is not None
        estimate = (
            self.watch(time_ns, image) if body is None else self.estimate(body, time_ns, image)
        )
        if estimate is None:
            return self._coast(time_ns)
        self._estimate = estimate
        self._time_ns = time_ns
        return estimate

    def remember_joints(self, joints: Array, time_ns: int) -> None:
        body = self._reader.read(joints, self.convention)
        if body is not None:
            self.remember(body, time_ns)

    def _coast(self, time_ns: int) -> Estimate:
        predicted = aged(self._estimate, time_ns - self._time_ns)
        if predicted.state == "lost":
            self._estimate = LOST
        return predicted


class FollowingTracker(ABC):
    """An ``ObjectTracker`` that starts a follower whenever somebody comes into view.

    A method's tracker calls ``restart`` when it has made itself.
    """

    def __init__(self, model: Model, *, left_handed: bool) -> None:
        self._mapping = model.mapping
        self._left_handed = left_handed
        self.effort = 1.0
        self.convention: str | None = None
        self._outline = VisiblePoints(model.viewpoints.directions, model.viewpoints.boundaries)
        self._follower: Follower

    @abstractmethod
    def _start(self, *, alone: bool) -> Follower:
        """A follower of somebody new; ``alone`` for one frame that leaves no trace in others."""

    def restart(self) -> None:
        """Forget the person and the object: somebody else comes into view."""
        self._follower = self._start(alone=False)

    def step(self, joints: Array | None, time_ns: int, image: Image | None = None) -> Estimate:
        """Take a frame: the person's joints (20, 3) in the camera frame, or None, and an image.

        Missing joints are NaN. While the body is not seen the last pose stands for a second, as
        predicted; then the object is lost. Some methods follow it by the image alone before.
        """
        self._follower.effort = self.effort
        self._follower.convention = self.convention
        return self._follower.step(joints, time_ns, image)

    def step_body(self, body: Body | None, time_ns: int, image: Image | None = None) -> Estimate:
        """Take a frame, as ``step``, of a body that a reader of ``new_reader`` has read."""
        self._follower.effort = self.effort
        return self._follower.step_body(body, time_ns, image)

    @property
    def learned_as(self) -> str | None:
        """The convention of the bodies that were learned from; None where that was not said."""
        return self._mapping.convention

    @property
    def trouble(self) -> str | None:
        """What is wrong with the convention of the joints; None where nothing is."""
        return self._follower.trouble

    @property
    def support(self) -> Support | None:
        """Support of the last image for the object; None where it shows nothing of it."""
        return self._follower.support

    def considered(self) -> Considered | None:
        """What the last frame's estimate was chosen from; None where no body was seen in it."""
        return self._follower.considered() if self._follower.estimated else None

    def remember(self, body: Body, time_ns: int) -> None:
        """Take a frame in which the object is not looked for; what the body did counts later."""
        self._follower.remember(body, time_ns)

    def remember_joints(self, joints: Array, time_ns: int) -> None:
        """Take a frame, as ``remember``, of joints (20, 3) in the camera frame."""
        self._follower.convention = self.convention
        self._follower.remember_joints(joints, time_ns)

    def estimate_single_frame(self, joints: Array, image: Image | None = None) -> Estimate:
        """Estimate the pose in a frame by itself; what is tracked is neither used nor changed."""
        follower = self._start(alone=True)
        follower.convention = self.convention
        return follower.step(joints, 1, image)

    def outline(self, estimate: Estimate, camera: Intrinsics) -> Array | None:
        """Pixels (B, 2) of the boundary of the object at an estimate; None for a lost one."""
        if estimate.translation is None or estimate.rotation is None:
            return None
        points = self._outline.place(estimate.translation[None], estimate.rotation[None])
        return camera.project(points[0])

    def new_reader(self) -> BodyReader:
        """A reader of bodies for trackers of this model and handedness."""
        return BodyReader(
            self._mapping,
            left_handed=self._left_handed,
            absent=self._mapping.absent_joints,
            convention=self._mapping.convention,
        )

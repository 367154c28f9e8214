"""The protocol of trackers: what every method's tracker can do."""

from typing import Protocol

from inhand_tracker.body.reader import Body, BodyReader
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.camera import Intrinsics
from inhand_tracker.geometry.considered import Considered
from inhand_tracker.geometry.estimate import Estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.sight.support import Support


class ObjectTracker(Protocol):
    """Follows one object of one person through the frames of one camera.

    ``effort``, above 0 and up to 1, is the share of its usual work that a step may take: a method
    that can do with less searches less, the others ignore it. ``convention`` names whose joints
    the next frames have, None where that is not said.
    """

    effort: float
    convention: str | None

    @property
    def learned_as(self) -> str | None:
        """The convention of the bodies that were learned from; None where that was not said."""

    @property
    def trouble(self) -> str | None:
        """What is wrong with the convention of the joints; None where nothing is."""

    @property
    def support(self) -> Support | None:
        """Support of the last image for the object; None where it shows nothing of it."""

    def considered(self) -> Considered | None:
        """What the last frame's estimate was chosen from; None where no body was seen in it."""

    def restart(self) -> None:
        """Forget the person and the object: somebody else comes into view."""

    def new_reader(self) -> BodyReader:
        """A reader of bodies for trackers of this model and handedness."""

    def step(self, joints: Array | None, time_ns: int, image: Image | None = None) -> Estimate:
        """Take a frame: the person's joints (20, 3) in the camera frame, or None, and an image."""

    def step_body(self, body: Body | None, time_ns: int, image: Image | None = None) -> Estimate:
        """Take a frame, as ``step``, of a body that a reader of ``new_reader`` has read."""

    def remember(self, body: Body, time_ns: int) -> None:
        """Take a frame in which the object is not looked for; what the body did counts later."""

    def remember_joints(self, joints: Array, time_ns: int) -> None:
        """Take a frame, as ``remember``, of joints (20, 3) in the camera frame."""

    def estimate_single_frame(self, joints: Array, image: Image | None = None) -> Estimate:
        """Estimate the pose in a frame by itself; what is tracked is neither used nor changed."""

    def outline(self, estimate: Estimate, camera: Intrinsics) -> Array | None:
        """Pixels (B, 2) of the boundary of the object at an estimate; None for a lost one."""

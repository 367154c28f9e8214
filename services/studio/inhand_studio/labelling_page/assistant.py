"""What the images say of an object's pose: of one frame, and of all between keyframes."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_lab.labelling.assisted_labels import AssistedLabels, assist
from inhand_lab.labelling.equal_poses import Pose
from inhand_lab.labelling.interpolation import interpolate
from inhand_lab.labelling.keyframes import Keyframe, LabellingError
from inhand_lab.labelling.pose_refinement import RefinedPose, refine_pose
from inhand_lab.labelling.scene import Scene
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.image import Image
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.viewpoints import Viewpoints, count_views, find_viewpoints
from inhand_tracker.sight.appearance import AppearanceSample, learn_appearance
from inhand_tracker.sight.sight import Sight

from inhand_studio.labelling_page.background import Advance
from inhand_studio.labelling_page.editing import Editing, Keyframes
from inhand_studio.labelling_page.opened import OpenedRecording
from inhand_studio.labelling_page.shown_pose import ShownPose

VIEWPOINTS_SHARE = 0.2
"""Share of the time of assistance that an object's views take the first time."""
MOST_SAMPLES = 12
"""Keyframes whose images an object's colours are learned from before one frame is looked at."""


@dataclass(frozen=True)
class Assistance:
    """Refined labels, and the keyframes between which they hold."""

    keyframes: Keyframes
    found: AssistedLabels

    def holds(self, editing: Editing, frame: int) -> bool:
        """Whether the keyframes around a frame are those that its pose was refined between."""
        mine = Editing(self.keyframes)
        around = editing.before(frame), editing.after(frame)
        return around == (mine.before(frame), mine.after(frame)) and editing.at(frame) is None

    def improve(self, shown: ShownPose, editing: Editing, frame: int) -> ShownPose:
        """Return the refined pose in place of one that is between keyframes, if there is one."""
        labels = self.found.labels
        if shown.standing != "between" or not self.holds(editing, frame):
            return shown
        pose = labels.translations[frame], labels.rotations[frame]
        if not np.isfinite(pose[0]).all():
            return shown
        return ShownPose(pose, "refined", f"it may be {100 * self.found.doubts[frame]:.1f} cm off")

    def worst(self, editing: Editing) -> int | None:
        """Return the frame with the greatest doubt between keyframes that still are; None without
        any."""
        doubts = self.found.doubts
        for frame in np.argsort(-np.nan_to_num(doubts)).tolist():
            if doubts[frame] > 0.0 and self.holds(editing, frame):
                return int(frame)
        return None


class Eyes:
    """An object's views, which are found once."""

    def __init__(self, shape: ObjectShape) -> None:
        self.shape = shape
        self._viewpoints: Viewpoints | None = None

    def viewpoints(self, advance: Advance) -> Viewpoints:
        """Find how the object looks from all sides, which takes seconds the first time."""
        if self._viewpoints is None:
            done = iter(np.linspace(0.0, 1.0, count_views() + 1)[1:])
            self._viewpoints = find_viewpoints(self.shape, on_view=lambda: advance(next(done)))
        return self._viewpoints

    def look(
        self,
        image: Image,
        pose: Pose,
        joints: Array,
        samples: Sequence[AppearanceSample],
        advance: Advance,
    ) -> RefinedPose:
        """Bring a pose to where an image shows the object; raises LabellingError where it says
        nothing of it."""
        sight = Sight(self.shape, self.viewpoints(advance), learn_appearance(self.shape, samples))
        refined = refine_pose(sight, image, pose, joints)
        if not refined.shown:
            raise LabellingError(
                "the image says nothing of the object here: move it nearer to where it is seen"
            )
        return refined


def samples_of(recording: OpenedRecording, keyframes: Sequence[Keyframe]) -> list[AppearanceSample]:
    """Return the images of keyframes with poses, a dozen at the most; raises RecordingError."""
    posed = [one for one in keyframes if one.pose is not None]
    step = max(1, len(posed) // MOST_SAMPLES)
    samples: list[AppearanceSample] = []
    for one in posed[::step]:
        image = recording.image(one.frame)
        if image is not None and one.pose is not None:
            samples.append((image, *one.pose, recording.joints([one.frame])[0]))
    return samples


def assistance(scene: Scene, keyframes: Keyframes, eyes: Eyes, advance: Advance) -> Assistance:
    """Refine all poses between keyframes; raises RecordingError and LabellingError."""
    way = interpolate(keyframes, scene.times_ns, scene.joints, eyes.shape.symmetries)
    if not way.stretches:
        raise LabellingError("set two keyframes or more, with frames between them, first")
    viewpoints = eyes.viewpoints(lambda share: advance(VIEWPOINTS_SHARE * share))
    shares = iter(np.linspace(VIEWPOINTS_SHARE, 1.0, len(way.stretches) + 1)[1:])
    found = assist(
        scene,
        keyframes,
        way,
        (eyes.shape, viewpoints),
        on_stretch=lambda: advance(float(next(shares))),
    )
    return Assistance(keyframes, found)

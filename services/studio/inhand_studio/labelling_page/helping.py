"""What helps a person on the labelling page: clicks, the image, the tracker; and the export."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from inhand_lab.labelling.equal_poses import Pose
from inhand_lab.labelling.keyframes import LabellingError
from inhand_lab.labelling.pose_refinement import RefinedPose
from inhand_lab.labelling.pose_start import pose_at_click, pose_from_clicks
from inhand_lab.labelling.scene import load_scene
from inhand_tracker.geometry.arrays import Array

from inhand_studio.clicked_point import point_on
from inhand_studio.dataset_files import find_models
from inhand_studio.labelling_page.assistant import (
    Assistance,
    Eyes,
    assistance,
    samples_of,
)
from inhand_studio.labelling_page.background import Advance
from inhand_studio.labelling_page.clicks import Picking, pixel_along
from inhand_studio.labelling_page.desk import Desk
from inhand_studio.labelling_page.estimates import (
    has_estimates,
    model_of,
    recorded_estimate,
    tracked_estimate,
)
from inhand_studio.labelling_page.export import proposed_entry
from inhand_studio.labelling_page.panel import Act


class Helping:
    """What helps at a desk."""

    def __init__(self, desk: Desk, eyes: Eyes) -> None:
        self._desk, self._eyes = desk, eyes
        self._visit = desk.visit
        self._background = desk.background
        self._picking: Picking | None = None
        self._placing = False
        self._listening = False

    def acts(self) -> Mapping[str, Act]:
        """Return what the keys and buttons do."""
        return {
            "start_clicks": self._start_clicks,
            "start_placing": self._start_placing,
            "end_clicks": self._end_clicks,
            "snap": self._snap,
            "assist": self._assist,
            "cancel": self._background.cancel,
            "worst": self._go_to_worst,
            "estimate": self._take_estimate,
        }

    # Clicks.

    def _start_clicks(self) -> None:
        self._desk.require_editable()
        self._desk.require_pose()
        self._picking, self._placing = Picking(), False
        self._listen()
        self._desk.ask(self._picking.next_click)

    def _start_placing(self) -> None:
        self._desk.require_editable()
        self._desk.require_pose()
        self._picking, self._placing = None, True
        self._listen()
        self._desk.ask("Click on the middle of the object in the image. Escape ends this.")

    def _listen(self) -> None:
        if not self._listening:
            self._listening = True
            self._desk.stage.await_clicks(True)
            self._visit.client.scene.on_click()(self._visit.action(self._clicked))

    def _end_clicks(self) -> None:
        if self._listening:
            self._listening = False
            self._desk.stage.await_clicks(False)
            self._visit.client.scene.remove_click_callback("all")
        self._picking, self._placing = None, False
        self._desk.ask("")

    def _clicked(self, event: Any) -> None:
        origin, direction = np.array(event.ray_origin), np.array(event.ray_direction)
        if self._placing:
            image = self._desk.require_image()
            pixel = pixel_along(image.camera, origin, direction)
            rotation = self._desk.require_pose()[1]
            pose = pose_at_click(self._desk.shape, rotation, image, pixel)
            self._end_clicks()
            self._desk.set_pose(pose)
        elif self._picking is not None:
            self._pick(self._picking, origin, direction)

    def _pick(self, picking: Picking, origin: Array, direction: Array) -> None:
        desk = self._desk
        if picking.point is None:
            point = point_on(desk.shape, desk.require_pose(), origin, direction)
            self._picking = picking.with_point(point)
        else:
            image = desk.require_image()
            self._picking = picking.with_pixel(pixel_along(image.camera, origin, direction))
        if not self._picking.done:
            desk.ask(self._picking.next_click)
            return
        pairs = self._picking.pairs
        self._end_clicks()
        desk.set_pose(pose_from_clicks(pairs, desk.require_image()))
        self._snap()

    # The image.

    def _snap(self) -> None:
        """Bring the shown pose to the image."""
        desk = self._desk
        desk.require_editable()
        pose, frame, recording = desk.require_pose(), desk.frame, desk.recording
        image = desk.require_image()
        joints = recording.joints([frame])[0]
        samples = samples_of(recording, desk.editing.keyframes)

        def work(advance: Advance) -> RefinedPose:
            return self._eyes.look(image, pose, joints, samples, advance)

        def done(refined: RefinedPose) -> None:
            desk.go(frame)
            desk.set_pose(refined.pose)
            moved_deg = np.rad2deg(refined.moved_rad)
            desk.ask(f"The image moved it {100 * refined.moved_m:.1f} cm and {moved_deg:.0f}°.")

        self._background.start("looking at the image", work, done)

    def _assist(self) -> None:
        """Refine all poses between keyframes in the background."""
        desk, keyframes, eyes = self._desk, self._desk.editing.keyframes, self._eyes
        recording, camera = desk.recording.path, desk.recording.camera

        def work(advance: Advance) -> Assistance:
            return assistance(load_scene(recording, camera), keyframes, eyes, advance)

        self._background.start("refining between keyframes", work, desk.take_assistance)

    def _go_to_worst(self) -> None:
        found = self._desk.assistance
        frame = None if found is None else found.worst(self._desk.editing)
        if frame is None:
            raise LabellingError("nothing is doubted: refine between keyframes first")
        self._desk.go(frame)

    def _take_estimate(self) -> None:
        """Take what a tracker said of this frame when it was recorded, or what a model says now."""
        desk, frame, name = self._desk, self._desk.frame, self._desk.shape.name
        desk.require_editable()

        def done(said: tuple[Pose, float]) -> None:
            desk.go(frame)
            desk.set_pose(said[0])
            desk.ask(f"The tracker's confidence is {100 * said[1]:.0f} %.")

        if has_estimates(desk.recording, name):
            done(recorded_estimate(desk.recording, name, frame))
            return
        studio, path, camera = self._visit.studio, desk.recording.path, desk.recording.camera
        models = find_models(studio.dataset, studio.models)
        left_handed = proposed_entry(studio.dataset, path, name).handedness == "left"

        def work(advance: Advance) -> tuple[Pose, float]:
            model = model_of(name, models)
            return tracked_estimate(path, camera, model, frame, advance, left_handed=left_handed)

        self._background.start("following with a model", work, done)

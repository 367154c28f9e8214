"""Draws a frame of a recording into a tab: its picture, its people, and its objects' poses."""

import numpy as np
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import ObjectPose
from inhand_tracker.wire.poses import pose_message

from inhand_studio.camera_view import CameraView, seen_by
from inhand_studio.drawn_scene import DrawnScene, PlacedObject
from inhand_studio.review_page.estimates import Estimates
from inhand_studio.review_page.recording import ReviewedRecording
from inhand_studio.review_page.texts import pose_text
from inhand_studio.scene_parts import TRACKED, TRUE
from inhand_studio.visit import Visit


class Drawing:
    """What a tab sees of one frame at a time; used with the visit's lock held."""

    def __init__(self, visit: Visit, recording: ReviewedRecording, estimates: Estimates) -> None:
        self._recording, self._estimates = recording, estimates
        self._client = visit.client
        self._scene = DrawnScene(visit.client.scene)
        self._view = CameraView(visit, seen_by(recording.info))
        self._opacity = 0.55

    def look_through(self) -> None:
        """Look through the camera."""
        self._view.look_through()

    def show(self, frame: int, with_truth: bool, with_recorded: bool) -> list[str]:
        """Show a frame, and return what is to be said of it; raises RecordingError."""
        said: list[str] = []
        with self._client.atomic():
            self._show_picture(frame, said)
            self._scene.draw_people(self._recording.people(frame))
            placed = self._true(frame) if with_truth else []
            placed += self._recorded(frame, said) if with_recorded else []
            self._scene.draw_objects([*placed, *self._made_anew(frame)])
        for name in dict.fromkeys(self._recording.objects):
            _, why = self._estimates.shape(name)
            said += [] if why is None else [why]
        return said

    def _show_picture(self, frame: int, said: list[str]) -> None:
        recording = self._recording
        picture = recording.picture(frame)
        if picture is None or recording.info is None:
            self._view.hide()
            if picture is not None:
                said.append("The recording describes no camera: its pictures cannot be drawn over.")
            return
        try:
            colour = picture.colour(recording.info)
        except MessageError as error:
            said.append(f"The picture of this frame is damaged: {error}.")
            colour = None
        if colour is None:
            self._view.hide()
        else:
            self._view.show(colour)

    def _true(self, frame: int) -> list[PlacedObject]:
        time_ns = int(self._recording.times_ns[frame])
        return [
            self._placed(f"true_{name}", label, True)
            for name, labels in self._recording.labels.items()
            for label in labels.at(time_ns)
            if label.camera_from_object is not None
        ]

    def _recorded(self, frame: int, said: list[str]) -> list[PlacedObject]:
        time_ns = int(self._recording.times_ns[frame])
        poses = [pose for one in self._recording.poses.values() for pose in one.at(time_ns)]
        said += map(pose_text, poses)
        return [
            self._placed(f"recorded_{pose.object}_{pose.person}", pose, False)
            for pose in poses
            if pose.camera_from_object is not None
        ]

    def _made_anew(self, frame: int) -> list[PlacedObject]:
        placed = []
        for number, one in enumerate(self._estimates.made_anew()):
            translation, rotation = one.track.translations[frame], one.track.rotations[frame]
            if np.isfinite(translation).all():
                shape, _ = self._estimates.shape(one.object)
                pose = pose_message(translation, rotation)
                slot = f"anew_{number}"
                placed.append(PlacedObject(slot, shape, pose, one.colour, self._opacity))
        return placed

    def _placed(self, slot: str, pose: ObjectPose, true: bool) -> PlacedObject:
        assert pose.camera_from_object is not None
        shape, _ = self._estimates.shape(pose.object)
        colour = TRUE if true else TRACKED
        return PlacedObject(slot, shape, pose.camera_from_object, colour, self._opacity)

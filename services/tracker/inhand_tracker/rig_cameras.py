"""What a live tracker sees of several cameras: their messages, joined moment by moment."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from functools import cache, partial

import msgspec
import numpy as np
from inhand_runtime.camera_infos import InfoWatch
from inhand_runtime.daemon import Daemon
from inhand_runtime.inbox import Received
from inhand_runtime.rig_calibration import RigCalibration
from inhand_schemas.messages import CameraInfo, Person, Pose, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, RGBD, SKELETONS

from inhand_tracker.cameras import (
    Bodies,
    Cameras,
    LiveFrame,
    count_unused,
    decoded,
    keys_of,
    subscribe,
)
from inhand_tracker.frames import camera_frame, source_of
from inhand_tracker.geometry.image import Image
from inhand_tracker.geometry.placement import Placement
from inhand_tracker.live.joining import Captured, JoinedMoment, JoinedMoments
from inhand_tracker.rig.people_fusing import person_message
from inhand_tracker.rig.placing import PlaceDeviation
from inhand_tracker.rig.rig_frames import Capture, RigFrame, RigFrames
from inhand_tracker.wire.conversion import Need

Frame = Callable[[], Image | None]
"""Gives what is needed of a camera's frame, decoded once, when it is first asked for; None where it
is damaged, or the camera is not known."""
Captures = Sequence[Captured[Skeletons, Frame]]


class RigCameras(Cameras):
    """Several cameras of a rig, in the order in which they are believed.

    Poses are those of the frame of the first camera that captured something of a moment. Where
    cameras are says their ``calibration``, or else their infos: nothing of a camera is used until
    that is known.
    """

    def __init__(
        self,
        daemon: Daemon,
        cameras: Sequence[str],
        needs: Collection[Need],
        calibration: RigCalibration,
        *,
        every: bool,
    ) -> None:
        self._daemon = daemon
        self._cameras = tuple(cameras)
        self._needs = needs
        self._calibration = calibration
        self._infos: dict[str, CameraInfo] = {}
        self._info_watch = InfoWatch(daemon.health)
        self._moments: JoinedMoments[Skeletons, Frame] = JoinedMoments(
            cameras, pixels=bool(needs), every=every
        )
        self._moment: JoinedMoment[Skeletons, Frame] | None = None
        self._frames: RigFrames | None = None
        self._places: dict[str, Pose] = {}
        self._undecoded: dict[str, Frame] = {}
        self._keys = {
            key: (topic, camera)
            for camera in cameras
            for topic, key in keys_of(daemon, camera).items()
        }
        for camera in cameras:
            subscribe(daemon, camera, pixels=bool(needs), every=every)

    @property
    def period_s(self) -> float:
        return self._moments.period_s

    def take(self, sample: Received, now: float) -> None:
        self._info_watch.check(now)
        topic, camera = self._keys[sample.key]
        if topic is INFO:
            if (info := self._daemon.decode(INFO, sample)) is not None:
                self._infos[camera] = info
                self._info_watch.note(INFO.stream, camera, now)
                self._place(camera, info)
        elif topic is RGBD:
            if (message := self._daemon.decode(RGBD, sample)) is not None:
                self._info_watch.note(RGBD.stream, camera, now)
                frame = self._undecoded[camera] = cache(partial(self._decode, camera, message))
                self._moments.add_frame(camera, message.sequence, frame, sample.arrived)
        elif (skeletons := self._daemon.decode(SKELETONS, sample)) is not None:
            time_ns = skeletons.time_ns + self._calibration.clock_offset_ns(camera)
            self._moments.add_skeleton(
                camera, skeletons.sequence, time_ns, skeletons, sample.arrived
            )

    def wait_s(self, now: float) -> float:
        return self._moments.wait_s(now)

    def decided(self) -> bool:
        return self._moments.decided()

    def next(self, now: float) -> Sequence[Bodies] | None:
        self._moment = self._moments.next(now)
        if self._moment is None:
            return None
        self._note_clocks()
        skipped = []
        for captured in self._moment.skipped:
            for one in captured:
                count_unused(self._daemon, one.camera, 1, int(one.frame is not None))
            frame = self._join(captured, images=False)
            if frame is not None:
                skipped.append(Bodies(_people(frame), frame.time_ns))
        return skipped

    def decode_ahead(self) -> None:
        """The newest frames are; where they come one after the other, only the last one of a moment
        is still to be decoded when all are there."""
        for camera, frame in self._undecoded.items():
            if camera in self._places:
                frame()
        self._undecoded.clear()

    def look(self, effort: float) -> LiveFrame:
        assert self._moment is not None
        captured = self._moment.captured
        first = captured[0]
        skeletons = _by_rig_clock(first)
        info = self._infos.get(first.camera)
        joined = self._join(captured, images=True)
        if joined is None:
            # Nothing is known of where the camera is: nobody is seen.
            frame = camera_frame(skeletons, None, None, effort)
            return LiveFrame((), frame, source_of(first.skeleton, first.camera, info))
        self._note_agreement()
        frame = camera_frame(skeletons, joined.image, info, effort)
        view = None if self._frames is None else self._frames.view_of(first.camera)
        return LiveFrame(
            _people(joined),
            replace(frame, view_from_reference=view),
            source_of(first.skeleton, first.camera, info, self._pose_in_rig(first.camera)),
        )

    def note_unused(self, skipped: int = 0) -> None:
        """Those of moments that are skipped were counted when they were."""
        for camera, skeletons, frames in self._moments.take_unused():
            count_unused(self._daemon, camera, skeletons, frames)

    def leave(self) -> None:
        self._moments.leave()
        self.note_unused()

    def _place(self, camera: str, info: CameraInfo) -> None:
        """Take a camera to be where its calibration says, or else its info."""
        calibrated = self._calibration.cameras.get(camera)
        place = info.rig_from_camera if calibrated is None else calibrated.rig_from_camera
        same = [other for other, one in self._places.items() if one == place and other != camera]
        if same:
            self._daemon.health.trouble(
                f"place {camera}",
                f"{camera} and {same[0]} are said to be at the same place, and {camera} adds "
                "nothing: `inhand calibrate` finds where they are",
            )
            return
        self._daemon.health.well(f"place {camera}")
        self._places[camera] = place
        self._arrange()

    def _arrange(self) -> None:
        """Let frames be joined of all cameras whose places are known, in the order of the rig."""
        known = {
            camera: Placement(np.array(place.translation), np.array(place.rotation))
            for camera in self._cameras
            if (place := self._places.get(camera)) is not None
        }
        if self._frames is None:
            self._frames = RigFrames(known)
        for camera, placement in known.items():
            self._frames.place(camera, placement, _deviation_of(self._calibration, camera))

    def _pose_in_rig(self, camera: str) -> Pose | None:
        """Where a camera is in the rig, as far as it is known by now."""
        if self._frames is None or camera not in self._places:
            return None
        place = self._frames.rig_from(camera)
        x, y, z = place.translation.tolist()
        qw, qx, qy, qz = place.rotation.tolist()
        return Pose((x, y, z), (qw, qx, qy, qz))

    def _join(self, captured: Captures, *, images: bool) -> RigFrame | None:
        """Join what cameras captured; None where no place of theirs is known."""
        known = [one for one in captured if one.camera in self._places]
        if self._frames is None or not known:
            return None
        captures = []
        for one in known:
            image = one.frame() if images and one.frame is not None else None
            captures.append(Capture(one.camera, one.time_ns, one.skeleton.people, image))
        return self._frames.join(captures)

    def _decode(self, camera: str, message: RgbdFrame) -> Image | None:
        return decoded(self._daemon, camera, message, self._infos.get(camera), self._needs)

    def _note_clocks(self) -> None:
        """Say whose clock is wrong."""
        odd = self._moments.odd_clocks()
        for camera in self._cameras:
            name = f"clock {camera}"
            if (ahead_s := odd.get(camera)) is None:
                self._daemon.health.well(name)
                continue
            way = "ahead of" if ahead_s > 0 else "behind"
            self._daemon.health.trouble(
                name,
                f"{camera}'s clock is {abs(ahead_s):.1f} s {way} the others', and it adds nothing: "
                "set the clocks of its host by NTP, or calibrate the rig anew",
            )

    def _note_agreement(self) -> None:
        """Say which camera is not where it is said to be."""
        left_out = {} if self._frames is None else self._frames.left_out
        misplaced = {} if self._frames is None else self._frames.misplaced
        for camera in self._cameras:
            name = f"calibration of {camera}"
            if (off_m := misplaced.get(camera)) is None or camera in left_out:
                self._daemon.health.well(name)
            else:
                self._daemon.health.trouble(
                    name,
                    f"what {camera} sees is {100 * off_m:.1f} cm off, which is more than its "
                    "calibration allows, and poses are worse: `inhand calibrate` finds where it is",
                )
            name = f"place of {camera}"
            if (off_m := left_out.get(camera)) is None:
                self._daemon.health.well(name)
                continue
            self._daemon.health.trouble(
                name,
                f"{camera} disagrees by {100 * off_m:.0f} cm with the others, and adds nothing: "
                "has somebody bumped it? `inhand calibrate` finds where it is now",
            )


def _by_rig_clock(captured: Captured[Skeletons, Frame]) -> Skeletons:
    """Return a capture's skeletons with their time by the rig's clock."""
    return msgspec.structs.replace(captured.skeleton, time_ns=max(captured.time_ns, 0))


def _deviation_of(calibration: RigCalibration, camera: str) -> PlaceDeviation | None:
    """How sure a calibration is of where a camera is; None where it does not say where it is."""
    calibrated = calibration.cameras.get(camera)
    if calibrated is None:
        return None
    shift, turn = calibrated.translation_deviation, calibrated.rotation_deviation
    return PlaceDeviation(
        float(np.sqrt(np.mean(np.square(shift)))), float(np.sqrt(np.mean(np.square(turn))))
    )


def _people(frame: RigFrame) -> list[Person]:
    return [person_message(one) for one in frame.people]

"""The tracker daemon: skeletons and pixels in, object poses out."""

import logging
import time
from pathlib import Path

from inhand_runtime.daemon import Daemon, running_daemon
from inhand_runtime.errors import SettingsError
from inhand_runtime.inbox import Received
from inhand_runtime.pixels import decode_grey
from inhand_runtime.session import Publisher
from inhand_runtime.settings import Section, Settings
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, Name, ObjectPose, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, POSE, RGBD, SKELETONS
from pydantic import Field, PositiveInt

from inhand_tracker.camera import intrinsics_of
from inhand_tracker.conversion import (
    box_around,
    joints_of,
    object_pose_message,
)
from inhand_tracker.following import Follower
from inhand_tracker.methods import DEFAULT_METHOD, METHODS, MethodName
from inhand_tracker.model_file import load_model
from inhand_tracker.pairing import Pairing
from inhand_tracker.tracking import PARTICLES, Image, Tracker

log = logging.getLogger(__name__)

POLL_S = 0.01


class TrackerSettings(Section):
    """``[tracker.NAME]``: one object of one person, seen by one camera."""

    model: Path | None = None
    camera: Name = "camera"
    method: MethodName = DEFAULT_METHOD
    left_handed: bool = False
    images: bool = True
    particles: PositiveInt = PARTICLES
    seed: int = Field(default=0, ge=0)


class TrackerService:
    """One frame after the other, from messages to messages."""

    def __init__(self, daemon: Daemon, settings: TrackerSettings, tracker: Tracker, name: str):
        self._daemon = daemon
        self._camera = settings.camera
        self._tracker = tracker
        self._object = name
        self._publisher: Publisher[ObjectPose] = daemon.publisher(POSE, name)
        self._pairing: Pairing[Skeletons, RgbdFrame] = Pairing()
        self._info: CameraInfo | None = None
        self._follower = Follower()
        daemon.subscribe(INFO, settings.camera)
        daemon.subscribe(SKELETONS, settings.camera)
        if settings.images:
            daemon.subscribe(RGBD, settings.camera)
        self._keys = {topic: topic.key(daemon.site, settings.camera) for topic in (INFO, RGBD)}

    def run(self) -> None:
        """Track until the daemon stops."""
        self._daemon.health.state = "running"
        while not self._daemon.stop.is_set():
            sample = self._daemon.inbox.get(POLL_S)
            if sample is not None:
                self._take(sample)
            while (pair := self._pairing.pop(time.monotonic())) is not None:
                self._track(*pair)

    def _take(self, sample: Received) -> None:
        now = time.monotonic()
        if sample.key == self._keys[INFO]:
            self._info = self._daemon.decode(INFO, sample) or self._info
        elif sample.key == self._keys[RGBD]:
            if (frame := self._daemon.decode(RGBD, sample)) is not None:
                self._pairing.add_frame(frame.sequence, frame, now)
        elif (skeletons := self._daemon.decode(SKELETONS, sample)) is not None:
            self._pairing.add_skeleton(skeletons.sequence, skeletons, now)

    def _track(self, skeletons: Skeletons, frame: RgbdFrame | None) -> None:
        before = self._follower.person_id
        person = self._follower.choose(skeletons.people, skeletons.time_ns)
        if self._follower.person_id != before:
            self._tracker.restart()
        estimate = self._tracker.step(
            None if person is None else joints_of(person),
            skeletons.time_ns,
            self._image(frame),
        )
        box = None
        if self._info is not None:
            camera = intrinsics_of(self._info)
            box = box_around(self._tracker.outline(estimate, camera), camera)
        self._publisher.put(
            object_pose_message(
                estimate,
                sequence=skeletons.sequence,
                time_ns=skeletons.time_ns,
                name=self._object,
                camera=self._camera,
                person=self._follower.person_id,
                rig_from_camera=None if self._info is None else self._info.rig_from_camera,
                box=box,
            )
        )
        self._daemon.health.latency(skeletons.time_ns)

    def _image(self, frame: RgbdFrame | None) -> Image | None:
        if frame is None or frame.colour is None or self._info is None:
            return None
        try:
            grey = decode_grey(frame.colour)
        except MessageError as error:
            self._daemon.health.malformed(self._keys[RGBD], error)
            return None
        camera = intrinsics_of(self._info).scaled_to(frame.colour.width, frame.colour.height)
        return Image(grey, camera)


def run(settings: Settings[TrackerSettings]) -> None:
    """Run until a signal; raises SettingsError or ModelError before anything starts."""
    chosen = settings.service
    if chosen.model is None:
        raise SettingsError(
            f'[tracker.{settings.instance}] names no model: write model = "FILE"; '
            "`inhand train` makes one"
        )
    model = load_model(chosen.model)
    tracker = Tracker(
        model,
        METHODS[chosen.method],
        left_handed=chosen.left_handed,
        particles=chosen.particles,
        seed=chosen.seed,
    )
    with running_daemon("tracker", settings) as daemon:
        log.info("tracking %s with %s", model.shape.name, chosen.method)
        TrackerService(daemon, chosen, tracker, model.shape.name).run()

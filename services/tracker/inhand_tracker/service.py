"""The tracker daemon: skeletons and pixels in, object poses out."""

import logging
import time
from collections.abc import Mapping
from pathlib import Path

from inhand_runtime.daemon import Daemon, running_daemon
from inhand_runtime.errors import SettingsError
from inhand_runtime.inbox import Received
from inhand_runtime.session import Publisher
from inhand_runtime.settings import Section, Settings
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, Name, ObjectPose, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, POSE, RGBD, SKELETONS
from pydantic import Field, PositiveInt

from inhand_tracker.camera import intrinsics_of
from inhand_tracker.conversion import (
    box_around,
    image_of,
    joints_of,
    object_pose_message,
)
from inhand_tracker.estimate import LOST, Estimate
from inhand_tracker.following import Follower
from inhand_tracker.image import Image
from inhand_tracker.likelihood import DEFAULT_TERMS, Term
from inhand_tracker.methods import DEFAULT_METHOD, METHODS, MethodName
from inhand_tracker.model_file import load_model
from inhand_tracker.pairing import Pairing
from inhand_tracker.tracking import PARTICLES, Tracker

log = logging.getLogger(__name__)

POLL_S = 0.01


class TrackerSettings(Section):
    """``[tracker.NAME]``: one object of one person or several, seen by one camera."""

    model: Path | None = None
    models: tuple[Path, ...] = ()
    camera: Name = "camera"
    method: MethodName = DEFAULT_METHOD
    left_handed: bool = False
    likelihood: tuple[Term, ...] = DEFAULT_TERMS
    particles: PositiveInt = PARTICLES
    seed: int = Field(default=0, ge=0)


class TrackerService:
    """One frame after the other, from messages to messages; ``trackers`` go by object."""

    def __init__(
        self, daemon: Daemon, settings: TrackerSettings, trackers: Mapping[str, Tracker]
    ) -> None:
        self._daemon = daemon
        self._camera = settings.camera
        self._terms = settings.likelihood
        self._trackers = trackers
        self._publishers: dict[str, Publisher[ObjectPose]] = {
            name: daemon.publisher(POSE, name) for name in trackers
        }
        self._failures: dict[str, str] = {}
        self._pairing: Pairing[Skeletons, RgbdFrame] = Pairing()
        self._info: CameraInfo | None = None
        self._follower = Follower()
        daemon.subscribe(INFO, settings.camera)
        daemon.subscribe(SKELETONS, settings.camera)
        if self._terms:
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
            for tracker in self._trackers.values():
                tracker.restart()
        joints = None if person is None else joints_of(person)
        image = self._image(frame)
        for name, tracker in self._trackers.items():
            try:
                self._publish(name, tracker.step(joints, skeletons.time_ns, image), skeletons)
            except Exception as error:  # noqa: BLE001 - one object must not stop the others
                self._note_failure(name, error)
                tracker.restart()
                self._publish(name, LOST, skeletons)
        self._daemon.health.latency(skeletons.time_ns)

    def _publish(self, name: str, estimate: Estimate, skeletons: Skeletons) -> None:
        box = None
        if self._info is not None:
            camera = intrinsics_of(self._info)
            box = box_around(self._trackers[name].outline(estimate, camera), camera)
        self._publishers[name].put(
            object_pose_message(
                estimate,
                sequence=skeletons.sequence,
                time_ns=skeletons.time_ns,
                name=name,
                camera=self._camera,
                person=self._follower.person_id,
                rig_from_camera=None if self._info is None else self._info.rig_from_camera,
                box=box,
            )
        )

    def _note_failure(self, name: str, error: Exception) -> None:
        text = f"cannot track {name}: {type(error).__name__}: {error}"
        if self._failures.get(name) != text:
            self._failures[name] = text
            self._daemon.health.error(text)
            log.debug("where it happened", exc_info=error)

    def _image(self, frame: RgbdFrame | None) -> Image | None:
        if frame is None or self._info is None:
            return None
        try:
            return image_of(frame, self._info, self._terms)
        except MessageError as error:
            self._daemon.health.malformed(self._keys[RGBD], error)
            return None


def run(settings: Settings[TrackerSettings]) -> None:
    """Run until a signal; raises SettingsError or ModelError before anything starts."""
    chosen = settings.service
    trackers = load_trackers(settings.instance, chosen)
    with running_daemon("tracker", settings) as daemon:
        log.info("tracking %s with %s", ", ".join(trackers), chosen.method)
        TrackerService(daemon, chosen, trackers).run()


def load_trackers(instance: str, settings: TrackerSettings) -> dict[str, Tracker]:
    """A tracker for each model, by object; raises SettingsError or ModelError."""
    where = f"[tracker.{instance}]"
    if settings.model is not None and settings.models:
        raise SettingsError(f'{where} has model and models: put all in models = ["FILE", …]')
    files = settings.models if settings.model is None else (settings.model,)
    if not files:
        raise SettingsError(
            f'{where} names no model: write model = "FILE"; `inhand train` makes one'
        )
    trackers: dict[str, Tracker] = {}
    for file in files:
        model = load_model(file)
        name = model.shape.name
        if name in trackers:
            raise SettingsError(f"{where} has two models of {name!r}: an object has one pose key")
        trackers[name] = Tracker(
            model,
            METHODS[settings.method],
            left_handed=settings.left_handed,
            terms=settings.likelihood,
            particles=settings.particles,
            seed=settings.seed,
        )
    return trackers

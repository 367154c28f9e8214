"""The tracker daemon: skeletons and pixels in, object poses out."""

import logging
import time
from collections import Counter
from collections.abc import Callable

from inhand_runtime.camera_infos import InfoWatch
from inhand_runtime.daemon import Daemon, running_daemon
from inhand_runtime.inbox import Received
from inhand_runtime.session import Publisher
from inhand_runtime.settings import Settings
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, ObjectPose, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, POSE, RGBD, SKELETONS

from inhand_tracker.geometry.camera import Intrinsics, intrinsics_of
from inhand_tracker.geometry.image import Image
from inhand_tracker.loading import check, load_watcher
from inhand_tracker.methods.registry import METHODS
from inhand_tracker.people.following import PeopleWatched, worth_publishing
from inhand_tracker.people.watching import CameraFrame, WatchedObject, Watcher
from inhand_tracker.settings import TrackerSettings
from inhand_tracker.wire.conversion import image_of
from inhand_tracker.wire.pairing import Pairing
from inhand_tracker.wire.pictures import PictureWatch
from inhand_tracker.wire.poses import SourceFrame, image_box, object_pose_message

log = logging.getLogger(__name__)

POLL_S = 0.01
"""Seconds that a look for new messages lasts: skeletons that wait for pixels go on as often."""
MOST_WAITING = 30
"""Number of skeletons that may wait to be tracked: a second at 30 Hz. Whoever is later than that is
better off with what comes next."""
FAILURE_LASTS_S = 5.0
"""Seconds for which an object that could not be tracked is a trouble of now."""


class TrackerService:
    """Tracks one frame after the other, from messages to messages; each person has a watcher."""

    def __init__(
        self, daemon: Daemon, settings: TrackerSettings, new_watcher: Callable[[], Watcher]
    ) -> None:
        self._daemon = daemon
        self._camera = settings.camera
        method = METHODS[settings.method]
        terms = method.usual_terms if settings.likelihood is None else settings.likelihood
        self._needs = method.needs(terms)
        self._people = PeopleWatched(new_watcher, settings.people)
        self._publishers: dict[str, Publisher[ObjectPose]] = {
            name: daemon.publisher(POSE, name) for name in self._people.names
        }
        self._unused: Counter[str] = Counter()
        self._infos = InfoWatch(daemon.health)
        self._pictures = PictureWatch(daemon.health)
        self._pairing: Pairing[Skeletons, RgbdFrame] = Pairing()
        self._info: CameraInfo | None = None
        daemon.subscribe(INFO, settings.camera)
        daemon.subscribe(SKELETONS, settings.camera, samples=MOST_WAITING)
        if self._needs:
            daemon.subscribe(RGBD, settings.camera)
        self._keys = {
            topic: topic.key(daemon.site, settings.camera) for topic in (INFO, RGBD, SKELETONS)
        }

    def run(self) -> None:
        """Track until the daemon stops."""
        self._daemon.health.state = "running"
        while not self._daemon.stop.is_set():
            self._take_all()
            pair = self._pairing.pop(time.monotonic())
            self._count_what_is_unused()
            if pair is not None:
                self._track(*pair)

    def _take_all(self) -> None:
        """Take what has come by now: only then is it known what is the newest."""
        sample = self._daemon.receive(0.0 if self._pairing.ready(time.monotonic()) else POLL_S)
        while sample is not None:
            self._take(sample)
            sample = self._daemon.receive(0.0)

    def _count_what_is_unused(self) -> None:
        for topic, count in (
            (SKELETONS, self._pairing.dropped_skeletons),
            (RGBD, self._pairing.unused_frames),
        ):
            for _ in range(count - self._unused[topic.stream]):
                self._daemon.health.dropped(self._keys[topic])
            self._unused[topic.stream] = count

    def _take(self, sample: Received) -> None:
        """Keep what a message brings until its frame is tracked."""
        now = time.monotonic()
        self._infos.check(now)
        if sample.key == self._keys[INFO]:
            if (info := self._daemon.decode(INFO, sample)) is not None:
                self._info = info
                self._infos.note(INFO.stream, self._camera, now)
        elif sample.key == self._keys[RGBD]:
            if (frame := self._daemon.decode(RGBD, sample)) is not None:
                self._infos.note(RGBD.stream, self._camera, now)
                self._pairing.add_frame(frame.sequence, frame, now)
        elif (skeletons := self._daemon.decode(SKELETONS, sample)) is not None:
            self._pairing.add_skeleton(skeletons.sequence, skeletons, now)

    def _track(self, skeletons: Skeletons, pixels: RgbdFrame | None) -> None:
        """Track one frame: decode, watch each person, publish."""
        frame = self._decoded(skeletons, pixels)
        if self._needs:
            self._pictures.note(frame.image is not None)
        objects = self._people.see(skeletons.people, frame, self._note_failure)
        source = self._source(skeletons)
        for person, thing in worth_publishing(objects):
            self._publish(person, thing, source, frame.camera)
        self._daemon.health.latency(skeletons.time_ns)

    def _decoded(self, skeletons: Skeletons, pixels: RgbdFrame | None) -> CameraFrame:
        camera = None if self._info is None else intrinsics_of(self._info)
        return CameraFrame(skeletons.time_ns, self._image(pixels), camera)

    def _image(self, frame: RgbdFrame | None) -> Image | None:
        if frame is None or self._info is None:
            return None
        try:
            return image_of(frame, self._info, self._needs)
        except MessageError as error:
            self._daemon.health.malformed(self._keys[RGBD], error)
            return None

    def _source(self, skeletons: Skeletons) -> SourceFrame:
        rig_from_camera = None if self._info is None else self._info.rig_from_camera
        return SourceFrame(skeletons.sequence, skeletons.time_ns, self._camera, rig_from_camera)

    def _publish(
        self,
        person: int | None,
        thing: WatchedObject,
        source: SourceFrame,
        camera: Intrinsics | None,
    ) -> None:
        message = object_pose_message(
            thing.estimate,
            source,
            name=thing.name,
            person=person,
            box=None if camera is None else image_box(thing.outline, camera),
            class_probabilities=thing.class_probabilities,
        )
        self._publishers[thing.name].put(message)

    def _note_failure(self, name: str, error: Exception) -> None:
        """Report a failure as a trouble while it lasts."""
        text = f"cannot track {name}: {type(error).__name__}: {error}"
        self._daemon.health.trouble(f"object {name}", text, lasts_s=FAILURE_LASTS_S)
        log.debug("where it happened", exc_info=error)


def run(settings: Settings[TrackerSettings]) -> None:
    """Run until a signal; raises SettingsError before anything starts."""
    chosen = settings.service
    first = check(settings)
    with running_daemon("tracker", settings) as daemon:
        log.info("tracking %s with %s", ", ".join(first.names), chosen.method)
        loaded = [first]

        def new_watcher() -> Watcher:
            return loaded.pop() if loaded else load_watcher(settings.instance, chosen)

        TrackerService(daemon, chosen, new_watcher).run()

"""The tracker daemon: skeletons and pixels in, object poses out."""

import logging
import time
from collections import Counter
from collections.abc import Callable, Mapping

from inhand_runtime.camera_infos import InfoWatch
from inhand_runtime.daemon import Daemon, running_daemon
from inhand_runtime.errors import SettingsError
from inhand_runtime.inbox import Received
from inhand_runtime.session import Publisher
from inhand_runtime.settings import FilePath, Section, Settings
from inhand_runtime.settings_errors import suggestion
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import CameraInfo, Name, ObjectPose, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, POSE, RGBD, SKELETONS
from pydantic import Field, PositiveInt

from inhand_tracker.geometry.camera import Intrinsics, intrinsics_of
from inhand_tracker.geometry.image import Image
from inhand_tracker.methods.object_tracker import ObjectTracker
from inhand_tracker.methods.registry import (
    DEFAULT_METHOD,
    METHODS,
    AnyTerm,
    MethodName,
    new_tracker,
)
from inhand_tracker.model.model import Model, ModelError
from inhand_tracker.model.model_file import load_model
from inhand_tracker.people.following import PeopleWatched, worth_publishing
from inhand_tracker.people.watching import (
    CameraFrame,
    GivenObjects,
    RecognisedObjects,
    WatchedObject,
    Watcher,
)
from inhand_tracker.recognition.cascade import Cascade
from inhand_tracker.recognition.recogniser_file import load_recogniser
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


class TrackerSettings(Section):
    """``[tracker.NAME]``: objects of one person or several, seen by one camera.

    With a ``recogniser`` each person uses at most one of the models' objects, whichever is
    recognised; without one every object is in use.
    """

    model: FilePath | None = None
    models: tuple[FilePath, ...] = ()
    camera: Name = "camera"
    method: MethodName = DEFAULT_METHOD
    left_handed: bool = False
    likelihood: tuple[AnyTerm, ...] | None = None
    particles: PositiveInt | None = None
    recogniser: FilePath | None = None
    people: PositiveInt = 1
    seed: int = Field(default=0, ge=0)


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


def check(settings: Settings[TrackerSettings]) -> Watcher:
    """Check all that can be known before a start, and load it; raises SettingsError."""
    _require_camera(settings)
    _require_files(settings)
    try:
        return load_watcher(settings.instance, settings.service)
    except ModelError as error:
        raise SettingsError(f"[tracker.{settings.instance}]: {error}") from None


def _require_camera(settings: Settings[TrackerSettings]) -> None:
    """Raise SettingsError for a camera that no table names.

    A file without cameras, and one that joins other machines, follow cameras of elsewhere.
    """
    cameras = settings.origin.instances.get("capture", ())
    camera, zenoh = settings.service.camera, settings.zenoh
    if not cameras or camera in cameras or zenoh.connect or zenoh.listen:
        return
    raise settings.origin.refusal(
        "camera", f"there is no table [capture.{camera}]" + suggestion(camera, cameras)
    )


def _require_files(settings: Settings[TrackerSettings]) -> None:
    """Raise SettingsError for a file that is not there."""
    chosen = settings.service
    models = (("models", file) for file in chosen.models)
    for setting, file in (("model", chosen.model), *models, ("recogniser", chosen.recogniser)):
        if file is not None and not file.exists():
            reason = f"{file} does not exist: check the path; `inhand train` makes it"
            raise settings.origin.refusal(setting, reason)


def load_watcher(instance: str, settings: TrackerSettings) -> Watcher:
    """Load all that it takes to watch one person; raises SettingsError or ModelError."""
    models = load_models(instance, settings)
    trackers = new_trackers(models, settings)
    if settings.recogniser is None:
        return GivenObjects(trackers)
    recogniser = load_recogniser(settings.recogniser)
    by_action = {model.interaction: name for name, model in models.items()}
    if missing := [action for action in recogniser.actions if action not in by_action]:
        raise SettingsError(
            f"[tracker.{instance}] recognises {missing[0]!r} and has no model of it: add it to "
            "models, or train the recogniser without it"
        )
    objects = [by_action[action] for action in recogniser.actions]
    cascade = Cascade(
        recogniser, [trackers[name] for name in objects], left_handed=settings.left_handed
    )
    return RecognisedObjects(cascade, objects)


def load_models(instance: str, settings: TrackerSettings) -> dict[str, Model]:
    """Load the models that are named, by object; raises SettingsError or ModelError."""
    where = f"[tracker.{instance}]"
    if settings.model is not None and settings.models:
        raise SettingsError(f'{where} has model and models: put all in models = ["FILE", …]')
    files = settings.models if settings.model is None else (settings.model,)
    if not files:
        raise SettingsError(
            f'{where} names no model: write model = "FILE"; `inhand train` makes one'
        )
    models: dict[str, Model] = {}
    for file in files:
        model = load_model(file)
        name = model.shape.name
        if name in models:
            raise SettingsError(f"{where} has two models of {name!r}: an object has one pose key")
        models[name] = model
    return models


def new_trackers(
    models: Mapping[str, Model], settings: TrackerSettings
) -> dict[str, ObjectTracker]:
    """Make a tracker for each model, by object; raises SettingsError or ModelError."""
    return {
        name: new_tracker(
            model,
            settings.method,
            left_handed=settings.left_handed,
            terms=settings.likelihood,
            particles=settings.particles,
            seed=settings.seed,
        )
        for name, model in models.items()
    }

"""The tracker daemon: skeletons and pixels in, object poses out."""

import logging
import time
from collections.abc import Callable, Sequence
from functools import cache, partial

import cv2
from inhand_runtime.calibration_watch import CalibrationWatch
from inhand_runtime.compiled import make_loops
from inhand_runtime.daemon import Daemon, running_daemon
from inhand_runtime.errors import InhandError
from inhand_runtime.memory import keep_memory
from inhand_runtime.rig_calibration import RigCalibration, read_rig_calibration
from inhand_runtime.session import Publisher
from inhand_runtime.settings import Settings
from inhand_schemas.messages import ObjectPose
from inhand_schemas.procedures import HYPOTHESES, RELOAD, ReloadReply, ReloadRequest
from inhand_schemas.topics import POSE

from inhand_tracker.cameras import Bodies, Cameras, OneCamera
from inhand_tracker.frames import needs_of, pose_messages
from inhand_tracker.hypotheses import HypothesesDesk
from inhand_tracker.live.effort import Effort, after_step
from inhand_tracker.live.shortfalls import Shortfall
from inhand_tracker.loading import check, load_watcher
from inhand_tracker.people.following import PeopleWatched
from inhand_tracker.people.watching import Watcher
from inhand_tracker.rig.people_fusing import compile_fusing
from inhand_tracker.rig_cameras import RigCameras
from inhand_tracker.settings import TrackerSettings

log = logging.getLogger(__name__)

POLL_S = 0.1
"""Seconds that a look for new messages lasts at the most: the daemon stops within them."""
MOST_TAKEN = 1024
"""Number of messages that are taken before the next step: a flood of them must not end all work."""
LEAVING_S = 0.5
"""Seconds that counting what is left takes at the most when the daemon stops."""
FAILURE_LASTS_S = 5.0
"""Seconds for which an object that could not be tracked is a trouble of now."""


class TrackerService:
    """Tracks one frame after the other, from messages to messages; each person has a watcher."""

    def __init__(
        self,
        daemon: Daemon,
        settings: TrackerSettings,
        new_watcher: Callable[[], Watcher],
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        self._daemon = daemon
        self._now = now
        self._needs = needs_of(settings)
        self._most_people = settings.people
        self._fresh: PeopleWatched | None = None
        self.desk = HypothesesDesk(daemon.instance)
        self._publishers: dict[str, Publisher[ObjectPose]] = {}
        self._watch(PeopleWatched(new_watcher, settings.people))
        self._pictures = Shortfall(
            daemon.health,
            "pictures",
            "poses are without picture: pictures come late or not at all, or this machine is too "
            "slow for them",
        )
        self._skeletons = Shortfall(
            daemon.health,
            "skeletons",
            "skeletons were skipped: this machine is too slow for all that it tracks",
        )
        self._every = settings.every_frame
        self._effort = Effort()
        self._cameras = _cameras_of(daemon, settings)
        self._calibration = CalibrationWatch(settings.calibration, daemon.health, now)

    def run(self) -> None:
        """Track until the daemon stops."""
        self._daemon.health.state = "running"
        while not self._daemon.stop.is_set():
            if (fresh := self._fresh) is not None:
                self._fresh = None
                self._watch(fresh)
            self._take_what_came()
            skipped = self._cameras.next(self._now())
            if skipped is None:
                self._cameras.decode_ahead()
            else:
                self._skip(skipped)
                began = self._now()
                if self._track():
                    self._adapt(self._now() - began)
        self._leave_what_waits()

    @property
    def names(self) -> tuple[str, ...]:
        """The objects that are followed, or will be with the next frame."""
        return (self._fresh or self._people).names

    def follow_anew(self, new_watcher: Callable[[], Watcher]) -> None:
        """Follow what these watchers do, with the next frame; from any thread."""
        self._fresh = PeopleWatched(new_watcher, self._most_people)

    def _watch(self, people: PeopleWatched) -> None:
        """Follow these people and what they use from here on."""
        self._people = people
        for name in people.names:
            if name not in self._publishers:
                self._publishers[name] = self._daemon.publisher(POSE, name)

    def _take_what_came(self) -> None:
        """Take what has come by now, since only then it is known what is the newest; where every
        frame matters, as much as the next moment needs, and let the rest wait in the inbox."""
        self._daemon.health.came_round()
        self._calibration.look()
        if self._every and self._cameras.decided():
            return
        timeout_s = min(self._cameras.wait_s(self._now()), POLL_S)
        for _ in range(MOST_TAKEN):
            sample = self._daemon.receive(timeout_s)
            if sample is None:
                return
            self._cameras.take(sample, self._now())
            if self._every and self._cameras.decided():
                return
            timeout_s = 0.0

    def _skip(self, skipped: Sequence[Bodies]) -> None:
        """Count moments that are skipped, and remember what bodies did in them."""
        for bodies in skipped:
            self._skeletons.note(True)
            self._people.remember(bodies.people, bodies.time_ns, self._note_failure)
        self._cameras.note_unused(len(skipped))

    def _leave_what_waits(self) -> None:
        """Count, at the end, what came and will not be tracked any more."""
        deadline = self._now() + LEAVING_S
        while self._now() < deadline and (sample := self._daemon.receive(0.0)) is not None:
            self._cameras.take(sample, self._now())
        self._cameras.leave()

    def _adapt(self, step_s: float) -> None:
        """Fit the next steps into the camera's period, unless every frame takes its time."""
        if not self._every:
            self._effort = after_step(self._effort, step_s, self._cameras.period_s)
        self._daemon.health.effort = self._effort.share

    def _track(self) -> bool:
        """Track one moment: decode, watch each person, publish; whether somebody is in it."""
        live = self._cameras.look(self._effort.share)
        self._skeletons.note(False)
        if self._needs:
            self._pictures.note(live.frame.image is None)
        objects = self._people.see(live.people, live.frame, self._note_failure)
        for message in pose_messages(objects, live.source, live.frame):
            self._publishers[message.object].put(message)
        if live.frame.view_from_reference is None:
            self.desk.answer(self._people, live.source)
        self._note_bodies()
        self._daemon.health.latency(live.frame.time_ns)
        return bool(live.people)

    def _note_bodies(self) -> None:
        """Say while skeletons are of another convention than the models, and cannot be mapped, or
        lack the hips that the models need."""
        trouble = self._people.trouble
        if trouble is None:
            self._daemon.health.well("convention")
        else:
            self._daemon.health.trouble("convention", trouble)
        lacking = self._people.hips_trouble
        if lacking is None:
            self._daemon.health.well("hips")
        else:
            self._daemon.health.trouble("hips", lacking)

    def _note_failure(self, name: str, error: Exception) -> None:
        """Report a failure as a trouble while it lasts."""
        text = f"cannot track {name}: {type(error).__name__}: {error}"
        self._daemon.health.trouble(f"object {name}", text, lasts_s=FAILURE_LASTS_S)
        log.debug("where it happened", exc_info=error)


def _cameras_of(daemon: Daemon, settings: TrackerSettings) -> Cameras:
    """The camera or the rig of cameras that settings name; raises SettingsError for a calibration
    that cannot be read."""
    needs, every = needs_of(settings), settings.every_frame
    if not settings.cameras:
        return OneCamera(daemon, settings.camera, needs, every=every)
    calibration = RigCalibration({})
    if settings.calibration is not None:
        calibration = read_rig_calibration(settings.calibration)
    return RigCameras(daemon, settings.cameras, needs, calibration, every=every)


def run(settings: Settings[TrackerSettings]) -> None:
    """Run until a signal; raises SettingsError before anything is tracked."""
    chosen, checked = settings.service, cache(partial(_prepare, settings))
    keep_memory()
    with running_daemon("tracker", settings, prepare=checked) as daemon:
        first = checked()
        log.info("tracking %s with %s", ", ".join(first.names), chosen.method)
        service = TrackerService(daemon, chosen, _watchers(settings, first))
        daemon.answer(HYPOTHESES, service.desk.ask)
        daemon.answer(RELOAD, lambda request: _reload(request, settings, service))
        service.run()


def _prepare(settings: Settings[TrackerSettings]) -> Watcher:
    """Make what no frame shall wait for, somebody's first one neither."""
    # Parts of images are small: a second thread has less to do than it waits for a core, on which
    # another process works, and the first one then waits for it.
    cv2.setNumThreads(1)
    watcher = check(settings)
    if settings.service.cameras:
        compile_fusing()
    make_loops()
    return watcher


def _watchers(settings: Settings[TrackerSettings], first: Watcher) -> Callable[[], Watcher]:
    """Return what makes a watcher for each person, of whom the first has one already."""
    loaded = [first]

    def new_watcher() -> Watcher:
        return loaded.pop() if loaded else load_watcher(settings.instance, settings.service)

    return new_watcher


def _reload(
    request: ReloadRequest, settings: Settings[TrackerSettings], service: TrackerService
) -> ReloadReply | None:
    """Load the models anew beside the work, and follow them; what cannot be loaded changes nothing.

    None where another tracker is asked.
    """
    name = settings.instance
    if request.tracker not in (None, name):
        return None
    try:
        service.follow_anew(_watchers(settings, load_watcher(name, settings.service)))
    except InhandError as error:
        return ReloadReply(tracker=name, objects=service.names, problem=str(error))
    log.info("loaded anew: %s", ", ".join(service.names))
    return ReloadReply(tracker=name, objects=service.names)

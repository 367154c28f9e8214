"""The capture service: the only file of capture that touches a session."""

import contextlib
import logging
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import TYPE_CHECKING, Any

from inhand_runtime.calibration_watch import CalibrationWatch
from inhand_runtime.daemon import Daemon, running_daemon
from inhand_runtime.errors import InhandError
from inhand_runtime.memory import keep_memory
from inhand_runtime.settings import Settings
from inhand_runtime.source import Captured, Source, SourceError, source_factory
from inhand_schemas.messages import Pose
from inhand_schemas.playback import PLAYBACK, PlaybackReply, PlaybackRequest
from inhand_schemas.procedures import (
    CONTROL,
    SHUTTER,
    ControlReply,
    ControlRequest,
    ShutterReply,
    ShutterRequest,
)
from inhand_schemas.topics import PREVIEW, SKELETONS
from msgspec import structs

from inhand_capture.preview import Previews
from inhand_capture.publishing import CameraPublisher
from inhand_capture.reopening import Ending, captures
from inhand_capture.settings import CaptureSettings, check, rig_from_camera
from inhand_capture.shutter import (
    POLL_S,
    EndOfCapture,
    Shutter,
    ShutteredOutlet,
    ShutteredOutlets,
    kept_shutter,
)
from inhand_capture.view.private_memory import forbid_core_dumps
from inhand_capture.view.viewed_source import FacelessPixels, viewed
from inhand_capture.watching import WatchedSource

if TYPE_CHECKING:  # what looks at pictures is loaded only where somebody shall
    from inhand_capture.estimation.found_person import PoseNetwork
    from inhand_capture.estimation.stage import SkeletonStage
    from inhand_capture.faces.finder import FaceFinder

log = logging.getLogger(__name__)

READER_POLL_S = 0.01
READER_SETTLES_S = 0.25


def run(settings: Settings[CaptureSettings]) -> None:
    """Publish until the source ends or a signal comes; raises SettingsError or InhandError."""
    chosen, prepared = settings.service, cache(partial(_prepare, settings))
    if chosen.masks or chosen.mask_faces:
        forbid_core_dumps()
    changed: dict[str, Any] = {}

    def open_source() -> Source:
        ready = prepared()
        source = source_factory(chosen.source)({**ready.options, **changed})
        return viewed(source, chosen.rotate, chosen.masks, ready.faces)

    shutter = kept_shutter(settings.site, settings.instance)
    keep_memory()
    with running_daemon("capture", settings, prepare=prepared) as daemon:
        ready = prepared()
        watched = WatchedSource(chosen.source, daemon.health)
        _offer_shutter(daemon, shutter)
        _offer_controls(daemon, watched, changed)
        _offer_playback(daemon, watched)
        try:
            with _skeleton_stage(daemon, ready.network, chosen, shutter) as stage:
                _publish(daemon, chosen, open_source, ready.mount, stage, shutter, watched)
        except SourceError as error:
            raise InhandError(f"source {chosen.source}: {error}") from error


@dataclass(frozen=True)
class _Ready:
    """What the settings name: the source's options, what looks at its pictures, and where the
    camera is in the rig, None where the source says it."""

    options: Mapping[str, Any]
    network: "PoseNetwork | None"
    faces: "FaceFinder | None"
    mount: Pose | None


def _prepare(settings: Settings[CaptureSettings]) -> _Ready:
    """Check the settings, and load what they name."""
    options, chosen = check(settings), settings.service
    network = _network(chosen)
    return _Ready(options, network, _face_finder(chosen, network), rig_from_camera(settings))


def _offer_shutter(daemon: Daemon, shutter: Shutter) -> None:
    """Let the shutter be moved by whoever asks, and show in the health how it is."""

    def move(request: ShutterRequest) -> ShutterReply | None:
        if request.camera not in (None, daemon.instance):
            return None
        problem = shutter.move(closed=request.closed)
        daemon.health.shutter_closed = request.closed
        return ShutterReply(camera=daemon.instance, closed=request.closed, problem=problem)

    daemon.health.shutter_closed = shutter.is_closed()
    daemon.answer(SHUTTER, move)


def _offer_controls(daemon: Daemon, watched: WatchedSource, changed: dict[str, Any]) -> None:
    """Let options be changed by whoever asks; ``changed`` keeps them until the daemon ends."""

    def change(request: ControlRequest) -> ControlReply | None:
        if request.camera != daemon.instance:
            return None
        try:
            watched.control(request.options)
        except SourceError as error:
            return ControlReply(camera=daemon.instance, problem=str(error))
        changed.update(request.options)
        log.info("changed while it runs: %s", request.options)
        return ControlReply(camera=daemon.instance)

    daemon.answer(CONTROL, change)


def _offer_playback(daemon: Daemon, watched: WatchedSource) -> None:
    """Let a recording that is played be paused, stepped through and sought by whoever asks."""

    def change(request: PlaybackRequest) -> PlaybackReply | None:
        if request.camera not in (None, daemon.instance):
            return None
        return watched.playback(request, daemon.instance)

    daemon.answer(PLAYBACK, change)


def _network(chosen: CaptureSettings) -> "PoseNetwork | None":
    """Load what finds people in pictures, where somebody has to be found."""
    if not chosen.looks_for_people():
        return None
    from inhand_capture.estimation.networks import open_network

    return open_network(chosen.network)


def _face_finder(chosen: CaptureSettings, network: "PoseNetwork | None") -> "FaceFinder | None":
    """Load what finds faces to hide; None where none shall be hidden."""
    if network is None or not chosen.mask_faces:
        return None
    from inhand_capture.faces.finder import open_face_finder

    return open_face_finder(network, trust_skeletons=chosen.skeletons == "source")


@contextlib.contextmanager
def _skeleton_stage(
    daemon: Daemon, network: "PoseNetwork | None", chosen: CaptureSettings, shutter: Shutter
) -> Iterator["SkeletonStage | None"]:
    """Run what estimates skeletons during the block; None where the source has its own."""
    if network is None or chosen.skeletons == "source":
        yield None
        return
    from inhand_capture.estimation.estimator import SkeletonEstimator
    from inhand_capture.estimation.networks import convention_of
    from inhand_capture.estimation.stage import SkeletonStage

    outlet = daemon.publisher(SKELETONS, daemon.instance)
    put = ShutteredOutlet(outlet, shutter).put
    with SkeletonStage(
        lambda info: SkeletonEstimator(network, info),
        put,
        daemon.health,
        outlet.key,
        convention_of(chosen.network),
    ) as stage:
        yield stage


def _publish(
    daemon: Daemon,
    chosen: CaptureSettings,
    open_source: Callable[[], Source],
    mount: Pose | None,
    stage: "SkeletonStage | None",
    shutter: Shutter,
    watched: WatchedSource,
) -> None:
    """Publish while the shutter is open; return when the source ends, or a signal comes."""
    outlets = ShutteredOutlets(daemon, shutter)
    camera = CameraPublisher(outlets, daemon.instance, chosen.depth_codec)
    previews = Previews(outlets.publisher(PREVIEW, daemon.instance), daemon.health)
    end = EndOfCapture(daemon.stop, shutter)
    calibration = CalibrationWatch(chosen.calibration, daemon.health)

    def wanted() -> bool:
        estimated = stage is not None and camera.wants_skeletons()
        return camera.wants_pixels() or previews.wanted() or estimated

    def opened(source: Source) -> None:
        info = source.info
        if mount is not None:
            info = structs.replace(info, rig_from_camera=mount)
        if stage is not None:
            stage.introduce(info)
        camera.introduce(info)
        watched.opened(source)
        heard = partial(_has_readers, camera, previews)
        _wait_for_readers(heard, chosen.wait_for_reader_s, daemon, end)

    while not daemon.stop.is_set():
        _wait_while_closed(daemon, shutter, watched)
        closings = shutter.closings
        for captured in captures(open_source, wanted, end, opened=opened, lost=watched.lost):
            daemon.health.came_round()
            watched.look()
            calibration.look()
            if captured is not None:
                _publish_moment(captured, camera, previews, stage)
                watched.captured()
                daemon.health.latency(captured.time_ns)
        if not end.is_set() and shutter.closings == closings:
            log.info("source %s has come to its end", chosen.source)
            return


def _wait_while_closed(daemon: Daemon, shutter: Shutter, watched: WatchedSource) -> None:
    """Capture nothing until the shutter opens, or a signal comes."""
    if not shutter.is_closed():
        return
    watched.shut()
    log.info("the shutter is closed: nothing is captured until `inhand shutter open`")
    while shutter.is_closed() and not daemon.stop.wait(POLL_S):
        daemon.health.came_round()


def _publish_moment(
    captured: Captured,
    camera: CameraPublisher,
    previews: Previews,
    stage: "SkeletonStage | None",
) -> None:
    """Publish a moment, whose pixels are got once; let its skeletons be estimated, where there is a
    stage, if anybody listens to them."""
    if captured.pixels is not None:
        captured = replace(captured, pixels=cache(captured.pixels))
    if stage is not None:
        captured = replace(captured, people=None)
    sequence = camera.publish(captured)
    previews.publish(captured, sequence)
    if stage is None or captured.pixels is None or not camera.wants_skeletons():
        return
    pixels = captured.pixels()
    if isinstance(pixels, FacelessPixels):
        stage.offer(sequence, captured.time_ns, pixels.whole, pixels.people)
    else:
        stage.offer(sequence, captured.time_ns, pixels)


def _has_readers(camera: CameraPublisher, previews: Previews) -> bool:
    """Whether anybody listens now."""
    return camera.has_readers() or previews.wanted()


def _wait_for_readers(
    heard: Callable[[], bool], seconds: float, daemon: Daemon, end: Ending
) -> None:
    """Wait until somebody listens, and then for the rest of what that reader asks for."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline and not end.wait(READER_POLL_S):
        daemon.health.came_round()
        if heard():
            end.wait(READER_SETTLES_S)
            return

"""The capture service: the only file of capture that touches a session."""

import contextlib
import logging
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any, Literal

from inhand_runtime.daemon import Daemon, running_daemon
from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.settings import FilePath, Section, Settings
from inhand_runtime.source import Captured, Source, SourceError, require_source, source_factory
from inhand_schemas.procedures import (
    CONTROL,
    SHUTTER,
    ControlReply,
    ControlRequest,
    ShutterReply,
    ShutterRequest,
)
from inhand_schemas.topics import SKELETONS
from pydantic import AfterValidator, Field, model_validator

from inhand_capture.publishing import CameraPublisher
from inhand_capture.reopening import Ending, captures
from inhand_capture.shutter import (
    POLL_S,
    EndOfCapture,
    Shutter,
    ShutteredOutlet,
    ShutteredOutlets,
    kept_shutter,
)
from inhand_capture.view.private_memory import forbid_core_dumps
from inhand_capture.view.viewed_source import viewed
from inhand_capture.watching import WatchedSource

if TYPE_CHECKING:  # what estimates skeletons is loaded only where they are estimated
    from inhand_capture.estimation.stage import SkeletonStage

log = logging.getLogger(__name__)

READER_POLL_S = 0.01
READER_SETTLES_S = 0.25

NO_CAMERA = (
    'no camera is configured: write [capture.front] with source = "oak" for a camera that '
    '`inhand capture --list` shows, source = "simulator", which needs none, or source = "replay" '
    "and the recording as options.file"
)


def _installed(source: str) -> str:
    try:
        require_source(source)
    except SourceError as error:
        raise ValueError(str(error)) from None
    return source


def _corner(corner: tuple[float, float]) -> tuple[float, float]:
    if not all(0.0 <= share <= 1.0 for share in corner):
        raise ValueError(
            f"{list(corner)} is no corner in the picture: write shares of its width and height, "
            "(0, 0) at its upper left and (1, 1) at its lower right"
        )
    return corner


Corner = Annotated[tuple[float, float], AfterValidator(_corner)]


class CaptureSettings(Section):
    """``[capture.NAME]``: which source publishes as the camera ``NAME``.

    ``options`` is the source's own table. The source starts as soon as somebody listens, at the
    latest after ``wait_for_reader_s`` seconds. Its own skeletons are published, or, where they are
    "estimated", those that a ``network`` finds in its pictures.

    ``rotate`` turns a camera's pictures clockwise, by degrees, so that people stand upright in
    them. ``masks`` are polygons of the turned picture that are burned in before anything leaves
    the process: lists of corners (x, y) as shares of its width and height.
    """

    source: Annotated[str, AfterValidator(_installed)]
    options: dict[str, Any] = {}
    wait_for_reader_s: Annotated[float, Field(ge=0, le=3600)] = 2.0
    skeletons: Literal["source", "estimated"] = "source"
    network: Literal["lite", "full", "heavy"] | FilePath = "lite"
    rotate: Literal[0, 90, 180, 270] = 0
    masks: tuple[Annotated[tuple[Corner, ...], Field(min_length=3)], ...] = ()

    @model_validator(mode="before")
    @classmethod
    def _require_source(cls, table: Any) -> Any:
        if not table:
            raise ValueError(NO_CAMERA)
        return table


def check(settings: Settings[CaptureSettings]) -> Mapping[str, Any]:
    """Check all that can be known before a start, and return the source's options.

    The source's class may say what its options are (``options_model``, a Section), and what of them
    can never work (``check_options``): see ``inhand_runtime.source``. Raises SettingsError.
    """
    chosen, origin = settings.service, settings.origin
    try:
        factory = source_factory(chosen.source)
    except SourceError as error:
        raise origin.refusal("source", str(error)) from None
    options: Mapping[str, Any] = chosen.options
    model: type[Section] | None = getattr(factory, "options_model", None)
    if model is not None:
        options = origin.checked(options, model, "options").model_dump(exclude_unset=True)
    try:
        getattr(factory, "check_options", _nothing)(options)
    except SourceError as error:
        raise origin.refusal("options", str(error)) from None
    if chosen.skeletons == "estimated":
        from inhand_capture.estimation.networks import require_network

        try:
            require_network(chosen.network)
        except SettingsError as error:
            raise origin.refusal("network", str(error)) from None
    return options


def run(settings: Settings[CaptureSettings]) -> None:
    """Publish until the source ends or a signal comes; raises SettingsError or InhandError."""
    chosen, options = settings.service, check(settings)
    if chosen.masks:
        forbid_core_dumps()

    changed: dict[str, Any] = {}

    def open_source() -> Source:
        source = source_factory(chosen.source)({**options, **changed})
        return viewed(source, chosen.rotate, chosen.masks)

    shutter = kept_shutter(settings.site, settings.instance)
    with running_daemon("capture", settings) as daemon:
        watched = WatchedSource(chosen.source, daemon.health)
        _offer_shutter(daemon, shutter)
        _offer_controls(daemon, watched, changed)
        try:
            with _skeleton_stage(daemon, chosen, shutter) as stage:
                _publish(daemon, chosen, open_source, stage, shutter, watched)
        except SourceError as error:
            raise InhandError(f"source {chosen.source}: {error}") from error


def _nothing(_options: Mapping[str, Any]) -> None:
    """Stands for the check that a source does not have."""


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


@contextlib.contextmanager
def _skeleton_stage(
    daemon: Daemon, chosen: CaptureSettings, shutter: Shutter
) -> Iterator["SkeletonStage | None"]:
    """Run what estimates skeletons during the block; None where the source has its own."""
    if chosen.skeletons == "source":
        yield None
        return
    from inhand_capture.estimation.estimator import SkeletonEstimator
    from inhand_capture.estimation.networks import open_network
    from inhand_capture.estimation.stage import SkeletonStage

    network = open_network(chosen.network)
    outlet = daemon.publisher(SKELETONS, daemon.instance)
    put = ShutteredOutlet(outlet, shutter).put
    with SkeletonStage(
        lambda info: SkeletonEstimator(network, info), put, daemon.health, outlet.key
    ) as stage:
        yield stage


def _publish(
    daemon: Daemon,
    chosen: CaptureSettings,
    open_source: Callable[[], Source],
    stage: "SkeletonStage | None",
    shutter: Shutter,
    watched: WatchedSource,
) -> None:
    """Publish while the shutter is open; return when the source ends, or a signal comes."""
    camera = CameraPublisher(ShutteredOutlets(daemon, shutter), daemon.instance)
    end = EndOfCapture(daemon.stop, shutter)

    def wanted() -> bool:
        return camera.wants_pixels() or (stage is not None and camera.wants_skeletons())

    def opened(source: Source) -> None:
        if stage is not None:
            stage.introduce(source.info)
        camera.introduce(source.info)
        watched.opened(source)
        _wait_for_readers(camera, chosen.wait_for_reader_s, daemon, end)

    while not daemon.stop.is_set():
        _wait_while_closed(daemon, shutter, watched)
        closings = shutter.closings
        for captured in captures(open_source, wanted, end, opened=opened, lost=watched.lost):
            daemon.health.came_round()
            watched.look()
            if captured is not None:
                if stage is None:
                    camera.publish(captured)
                else:
                    _publish_to_estimate(camera, captured, stage)
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


def _publish_to_estimate(
    camera: CameraPublisher, captured: Captured, stage: "SkeletonStage"
) -> None:
    """Publish a moment without its source's skeletons, and let others be estimated, if anybody
    listens to them."""
    if captured.pixels is None:
        camera.publish(replace(captured, people=None))
        return
    pixels = cache(captured.pixels)
    sequence = camera.publish(replace(captured, people=None, pixels=pixels))
    if camera.wants_skeletons():
        stage.offer(sequence, captured.time_ns, pixels())


def _wait_for_readers(camera: CameraPublisher, seconds: float, daemon: Daemon, end: Ending) -> None:
    """Wait until somebody listens, and then for the rest of what that reader asks for."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline and not end.wait(READER_POLL_S):
        daemon.health.came_round()
        if camera.has_readers():
            end.wait(READER_SETTLES_S)
            return

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
from inhand_schemas.topics import SKELETONS
from pydantic import AfterValidator, Field, model_validator

from inhand_capture.publishing import CameraPublisher
from inhand_capture.reopening import captures
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

    def open_source() -> Source:
        source = source_factory(chosen.source)(options)
        return viewed(source, chosen.rotate, chosen.masks)

    with running_daemon("capture", settings) as daemon:
        try:
            with _skeleton_stage(daemon, chosen) as stage:
                _publish(daemon, chosen, open_source, stage)
        except SourceError as error:
            raise InhandError(f"source {chosen.source}: {error}") from error


def _nothing(_options: Mapping[str, Any]) -> None:
    """Stands for the check that a source does not have."""


@contextlib.contextmanager
def _skeleton_stage(daemon: Daemon, chosen: CaptureSettings) -> Iterator["SkeletonStage | None"]:
    """Run what estimates skeletons during the block; None where the source has its own."""
    if chosen.skeletons == "source":
        yield None
        return
    from inhand_capture.estimation.estimator import SkeletonEstimator
    from inhand_capture.estimation.networks import open_network
    from inhand_capture.estimation.stage import SkeletonStage

    network = open_network(chosen.network)
    outlet = daemon.publisher(SKELETONS, daemon.instance)
    with SkeletonStage(
        lambda info: SkeletonEstimator(network, info), outlet.put, daemon.health, outlet.key
    ) as stage:
        yield stage


def _publish(
    daemon: Daemon,
    chosen: CaptureSettings,
    open_source: Callable[[], Source],
    stage: "SkeletonStage | None",
) -> None:
    camera = CameraPublisher(daemon, daemon.instance)
    watched = WatchedSource(chosen.source, daemon.health)

    def wanted() -> bool:
        return camera.wants_pixels() or (stage is not None and camera.wants_skeletons())

    def opened(source: Source) -> None:
        if stage is not None:
            stage.introduce(source.info)
        camera.introduce(source.info)
        watched.opened(source)
        _wait_for_readers(camera, chosen.wait_for_reader_s, daemon)

    for captured in captures(open_source, wanted, daemon.stop, opened=opened, lost=watched.lost):
        daemon.health.came_round()
        watched.look()
        if captured is not None:
            if stage is None:
                camera.publish(captured)
            else:
                _publish_to_estimate(camera, captured, stage)
            watched.captured()
            daemon.health.latency(captured.time_ns)
    if not daemon.stop.is_set():
        log.info("source %s has come to its end", chosen.source)


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


def _wait_for_readers(camera: CameraPublisher, seconds: float, daemon: Daemon) -> None:
    """Wait until somebody listens, and then for the rest of what that reader asks for."""
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline and not daemon.stop.wait(READER_POLL_S):
        daemon.health.came_round()
        if camera.has_readers():
            daemon.stop.wait(READER_SETTLES_S)
            return

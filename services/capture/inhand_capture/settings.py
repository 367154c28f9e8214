"""The settings of a capture daemon, and what can be known of them before a start."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from inhand_runtime.errors import SettingsError
from inhand_runtime.rig_calibration import calibration_of
from inhand_runtime.settings import FilePath, Section, Settings
from inhand_runtime.source import SourceError, require_source, source_factory
from inhand_schemas.messages import Pose
from pydantic import AfterValidator, Field, model_validator

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
    the process: lists of corners (x, y) as shares of its width and height. ``mask_faces`` burns in
    all faces that are found, too.

    Depth is published as ``depth_codec`` says; what is encoded already stays as it is unless that
    is "png16".

    ``calibration`` is the file that ``inhand calibrate`` wrote: where the camera is in the rig,
    which is published in place of what the source says.
    """

    source: Annotated[str, AfterValidator(_installed)]
    options: dict[str, Any] = {}
    wait_for_reader_s: Annotated[float, Field(ge=0, le=3600)] = 2.0
    skeletons: Literal["source", "estimated"] = "source"
    network: Literal["lite", "full", "heavy"] | FilePath = "full"
    rotate: Literal[0, 90, 180, 270] = 0
    masks: tuple[Annotated[tuple[Corner, ...], Field(min_length=3)], ...] = ()
    mask_faces: bool = False
    depth_codec: Literal["z16-zstd", "png16"] = "z16-zstd"
    calibration: FilePath | None = None

    def looks_for_people(self) -> bool:
        """Whether a network has to find people in the pictures."""
        return self.skeletons == "estimated" or self.mask_faces

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
    _check_networks(settings)
    rig_from_camera(settings)
    return options


def rig_from_camera(settings: Settings[CaptureSettings]) -> Pose | None:
    """Read where the camera is in the rig; None where no calibration is named.

    Raises SettingsError for a file that is wrong, or does not name the camera.
    """
    path = settings.service.calibration
    if path is None:
        return None
    try:
        return calibration_of(path, settings.instance).rig_from_camera
    except SettingsError as error:
        raise settings.origin.refusal("calibration", str(error)) from None


def _check_networks(settings: Settings[CaptureSettings]) -> None:
    """Check that what looks at pictures can be loaded, where the settings ask for it."""
    chosen, origin = settings.service, settings.origin
    if chosen.looks_for_people():
        from inhand_capture.estimation.networks import require_network

        try:
            require_network(chosen.network)
        except SettingsError as error:
            raise origin.refusal("network", str(error)) from None
    if chosen.mask_faces:
        from inhand_capture.faces.finder import require_face_detector

        try:
            require_face_detector()
        except SettingsError as error:
            raise origin.refusal("mask_faces", str(error)) from None


def _nothing(_options: Mapping[str, Any]) -> None:
    """Stands for the check that a source does not have."""

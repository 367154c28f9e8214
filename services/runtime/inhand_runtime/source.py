"""What a camera source is: the plugin interface of the entry-point group ``inhand.sources``.

A source is made by calling the entry point with the free-form table that the user wrote under
``[capture.NAME.options]``; it raises SourceError when that cannot work.

So that what can be known is checked before a start, a source's class may have ``options_model``,
a ``Section`` that checks that table (paths in it are ``FilePath``), and ``check_options``, called
with the table as checked: it raises SourceError for what can never work, and opens no device.

A source that knows how its device is may have ``troubles()``, which gives by name what is wrong
though moments come. Capture asks once a second, and shows it in its health. One whose device can
be changed while it runs may have ``control(options)``, called from any thread with some of its
options, None for what shall be automatic; it raises SourceError for what cannot be changed so.
One that plays something recorded may have ``playback(request, camera)``, called from any thread,
which pauses it, or goes elsewhere, and replies how it is played then.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from importlib.metadata import EntryPoint, entry_points
from typing import Any, Protocol

from inhand_schemas.messages import (
    CameraInfo,
    ColourImage,
    DepthImage,
    ObjectPose,
    Person,
)
from inhand_schemas.playback import PlaybackReply, PlaybackRequest
from numpy import uint8, uint16
from numpy.typing import NDArray

from inhand_runtime.extras import missing_extra

ENTRY_POINT_GROUP = "inhand.sources"


QUIET_S = 1.0
"""Seconds after which a source that has nothing to give says so."""


class SourceError(Exception):
    """A source that cannot start or go on; the message says the mend."""


class SourceLostError(SourceError):
    """A device that went away and may come back: capture opens the source again."""


class SourceAbsentError(SourceLostError):
    """A device that is not there, not free or not allowed, which whoever uses it can mend.

    Capture waits for it. For seconds after a loss it is only restarting.
    """


@dataclass(frozen=True)
class Pixels:
    """One picture: raw arrays, or images that are encoded already (a recording's).

    Colour is (H, W, 3) RGB, depth (H, W) in the camera's depth units, 0 = not measured.
    """

    colour: NDArray[uint8] | ColourImage | None
    depth: NDArray[uint16] | DepthImage | None


@dataclass(frozen=True)
class Captured:
    """One moment as a source gives it. ``pixels`` is called only when somebody listens.

    ``convention`` names whose joints ``people`` have (``inhand_schemas.conventions``); None where
    that is not said.
    """

    time_ns: int
    time_uncertainty_ns: int
    pixels: Callable[[], Pixels] | None
    people: tuple[Person, ...] | None
    labels: tuple[ObjectPose, ...] = ()
    convention: str | None = None


class Source(Protocol):
    """A camera, a recording or a simulated world."""

    @property
    def info(self) -> CameraInfo:
        """How it sees; capture fills in the sequence, and the time where it is 0."""

    def captures(self, wanted: Callable[[], bool]) -> Iterator[Captured | None]:
        """Moments at the pace at which they happen; ``wanted`` says whether pixels are.

        While nothing happens it gives None at least once a second (``QUIET_S``), so that a source
        that waits differs from one that hangs. Ends when the source has no more. Raises
        SourceLostError when a device went away, and SourceError when opening it again cannot help.
        """

    def close(self) -> None:
        """Release the device, from any thread and also twice; waiting ``captures`` end soon."""


def control_source(source: Source, options: Mapping[str, Any]) -> None:
    """Change options of a source that runs; raises SourceError where that cannot be done."""
    control: Callable[[Mapping[str, Any]], None] | None = getattr(source, "control", None)
    if control is None:
        raise SourceError("nothing of this source can be changed while it runs")
    control(options)


def control_playback(source: Source, request: PlaybackRequest, camera: str) -> PlaybackReply:
    """Change how a source plays what is recorded; the reply says why that cannot be done."""
    control: Callable[[PlaybackRequest, str], PlaybackReply] | None = getattr(
        source, "playback", None
    )
    if control is None:
        return PlaybackReply(camera=camera, problem="its source plays no recording")
    return control(request, camera)


SourceFactory = Callable[[Mapping[str, Any]], Source]


def require_source(name: str) -> EntryPoint:
    """Where the source of that name is installed, without loading it; raises SourceError."""
    found = {entry.name: entry for entry in entry_points(group=ENTRY_POINT_GROUP)}
    if name not in found:
        raise SourceError(f"no source {name!r} is installed; there are: {', '.join(sorted(found))}")
    return found[name]


def source_factory(name: str) -> SourceFactory:
    """The installed source of that name; raises SourceError."""
    entry = require_source(name)
    try:
        factory: SourceFactory = entry.load()
    except ModuleNotFoundError as error:
        needs = missing_extra(error) or (
            f"needs the package {error.name}, which is not installed: "
            f"run pip install 'inhand[{name}]'"
        )
        raise SourceError(f"source {name!r} {needs}") from error
    return factory

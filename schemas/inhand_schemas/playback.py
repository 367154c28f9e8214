"""The procedure by which a recording that is being played is paused, stepped through and sought.

Every camera answers; one whose source plays nothing says so.
"""

from typing import Literal

from msgspec import Struct

from inhand_schemas.fields import Name, Nanoseconds, Text
from inhand_schemas.procedure import Procedure

PlaybackAction = Literal["status", "pause", "resume", "step", "seek", "skip", "rate"]


class PlaybackRequest(Struct, frozen=True, kw_only=True):
    """Change how a recording is played, of one camera or of all.

    ``step`` plays one more moment of a paused one. ``value`` is the recorded seconds from the begin
    for ``seek``, the recorded seconds forward (or back, below 0) for ``skip``, and the rate for
    ``rate``; other actions have none.
    """

    action: PlaybackAction
    value: float | None = None
    camera: Name | None = None


class PlaybackReply(Struct, frozen=True, kw_only=True):
    """How a recording is played from now on; ``problem`` is why it is not as it was wished.

    ``position_s`` and ``length_s`` are recorded seconds from the begin: of the moment that was
    played last, None before the first, and of the end. ``captured_ns`` is when that moment was
    recorded, whatever time it was published with.
    """

    camera: Name
    paused: bool = False
    rate: float = 1.0
    position_s: float | None = None
    length_s: float = 0.0
    captured_ns: Nanoseconds | None = None
    problem: Text | None = None


PLAYBACK = Procedure("capture", "playback", PlaybackRequest, PlaybackReply, "camera")

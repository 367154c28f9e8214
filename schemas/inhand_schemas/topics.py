"""Topics: a stream's message type, delivery and encoding in one object."""

import re
from dataclasses import dataclass
from functools import lru_cache
from typing import Generic, Literal, TypeVar

import msgspec

from inhand_schemas import messages
from inhand_schemas.errors import KeyFormatError, MessageError, UnknownVersionError
from inhand_schemas.keys import ParsedKey, Site, parse_key

T = TypeVar("T", bound=messages.Message)

_ENCODING = re.compile(r"application/msgpack;(\w+)\.v(\d{1,9})")
_encoder = msgspec.msgpack.Encoder()


@dataclass(frozen=True)
class Delivery:
    """Quality of service of a stream, in words of our own.

    ``newest`` readers keep the newest messages only, ``every`` readers queue them; a ``kept``
    stream hands its last message to late joiners, and repeats it. Where a link's queue is full,
    ``drop`` drops a message and ``wait_for_first`` lets a fragmented one that is under way finish;
    in both a slow reader never slows another, nor the publisher. Small messages ``drop``: a busy
    machine loses some of a burst of them that would ``wait_for_first``.
    """

    readers: Literal["newest", "every"]
    congestion: Literal["drop", "wait_for_first"]
    priority: Literal["urgent", "normal", "bulk"]
    kept: bool = False


BULK = Delivery("newest", "wait_for_first", "bulk")
URGENT = Delivery("every", "drop", "urgent")
RELIABLE = Delivery("every", "drop", "normal")
KEPT = Delivery("every", "drop", "normal", kept=True)


class Topic(Generic[T]):
    """A stream: ``topic.key(site, name)``, ``topic.encode(message)``, ``topic.decode(bytes)``.

    ``gaps_are_losses`` says that a key's messages are numbered one by one. Skeletons, poses and
    previews have the numbers of the frames that they are of: who estimates and is behind leaves
    some out, and previews are of few. So have labels, which every camera of a rig that sees the
    object publishes on its one key. ``named`` is the field of a message that has the name of its
    key, where one does. ``viewed`` is the type that ``check`` decodes, where large fields can be
    views of what is decoded.
    """

    def __init__(
        self,
        stream: str,
        message_type: type[T],
        delivery: Delivery,
        *,
        gaps_are_losses: bool = True,
        named: str | None = None,
        viewed: type[T] | None = None,
    ) -> None:
        self.stream = stream
        self.message_type = message_type
        self.delivery = delivery
        self.gaps_are_losses = gaps_are_losses
        self.named = named
        self.encoding = f"application/msgpack;{message_type.__name__}.v1"
        self._decoder = msgspec.msgpack.Decoder(message_type)
        self._checker = msgspec.msgpack.Decoder(viewed or message_type)

    def key(self, site: Site, name: str) -> str:
        """The key of one camera, object, kind or instance; raises KeyFormatError."""
        return site.key(self.stream, name)

    def pattern(self, site: Site) -> str:
        """All names of this stream, as a Zenoh key expression."""
        return site.pattern(self.stream)

    def encode(self, message: T) -> bytes:
        """The message as MessagePack; raises MessageError for one of another type."""
        if not isinstance(message, self.message_type):
            raise MessageError(
                f"{self.stream} carries {self.message_type.__name__}, not {type(message).__name__}"
            )
        return _encoder.encode(message)

    def decode(self, data: bytes, encoding: str | None = None) -> T:
        """The message in ``data``.

        Raises MessageError, or UnknownVersionError when ``encoding`` names another version.
        """
        return self._decoded(self._decoder, data, encoding)

    def check(self, data: bytes, encoding: str | None = None) -> T:
        """The message in ``data``, decoded for a look: its pictures are no copies, but views of
        ``data``. Raises as ``decode`` does."""
        return self._decoded(self._checker, data, encoding)

    def _decoded(self, decoder: msgspec.msgpack.Decoder[T], data: bytes, encoding: str | None) -> T:
        if encoding is not None:
            self._check_encoding(encoding)
        try:
            return decoder.decode(data)
        except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
            raise MessageError(f"no valid {self.message_type.__name__}: {error}") from None

    def received(self, key: str, data: bytes, encoding: str | None = None) -> T:
        """The message in ``data`` that came on a key, on whose name alone its sender may be let.

        Raises MessageError, also for a message in another's name, or UnknownVersionError.
        """
        message = self.decode(data, encoding)
        if self.named is not None:
            name = getattr(message, self.named)
            if name != key.rpartition("/")[2]:
                raise MessageError(f"a {self.message_type.__name__} in the name of {name!r}")
        return message

    def _check_encoding(self, encoding: str) -> None:
        if encoding == self.encoding:
            return
        match = _ENCODING.fullmatch(encoding)
        if match is None or match[1] != self.message_type.__name__:
            raise MessageError(f"{self.stream} carries {self.encoding}, not {encoding!r}")
        if match[2] != "1":
            raise UnknownVersionError(
                f"{match[1]} comes in version {match[2]}, and this release reads version 1: "
                "update the older side"
            )


INFO = Topic("info", messages.CameraInfo, KEPT)
RGBD = Topic("rgbd", messages.RgbdFrame, BULK, viewed=messages.ViewedFrame)
PREVIEW = Topic("preview", messages.Preview, BULK, gaps_are_losses=False)
SKELETONS = Topic("skeletons", messages.Skeletons, URGENT, gaps_are_losses=False)
POSE = Topic("pose", messages.ObjectPose, URGENT, gaps_are_losses=False, named="object")
EVENT = Topic("event", messages.Event, RELIABLE)
LABEL = Topic("label", messages.ObjectPose, RELIABLE, gaps_are_losses=False, named="object")
HEALTH = Topic("health", messages.Health, URGENT, named="instance")

AnyTopic = (
    Topic[messages.CameraInfo]
    | Topic[messages.RgbdFrame]
    | Topic[messages.Preview]
    | Topic[messages.Skeletons]
    | Topic[messages.ObjectPose]
    | Topic[messages.Event]
    | Topic[messages.Health]
)

TOPICS: dict[str, AnyTopic] = {
    topic.stream: topic for topic in (INFO, RGBD, PREVIEW, SKELETONS, POSE, EVENT, LABEL, HEALTH)
}


@lru_cache(maxsize=1024)
def topic_of(key: str) -> tuple[AnyTopic, ParsedKey]:
    """The topic that a key belongs to; raises KeyFormatError, or UnknownVersionError."""
    parsed = parse_key(key)
    topic = TOPICS.get(parsed.stream)
    if topic is None:
        raise KeyFormatError(f"{key!r}: there is no stream {parsed.stream!r}")
    return topic, parsed

"""A recording's messages put together again as the moments at which they were captured."""

from collections.abc import Callable, Iterable, Iterator
from functools import partial

from inhand_runtime.pixels import raw_colour
from inhand_runtime.recording import RecordedMessage
from inhand_runtime.source import Captured, Pixels
from inhand_schemas.errors import MessageError
from inhand_schemas.messages import Message, ObjectPose, RgbdFrame, Skeletons

LOOK_AHEAD_NS = 500_000_000

Moment = list[RecordedMessage]


def moments(
    recorded: Iterable[RecordedMessage],
    camera: str,
    on_unreadable: Callable[[MessageError], None],
) -> Iterator[Captured]:
    """What a camera captured, in the order of capture.

    Messages of one sequence number and time belong together; they may lie as far apart in the
    recording as was received within half a second. Where the recorded clock was set back, what
    comes after in the file comes after. A message that cannot be decoded is passed over.
    """
    waiting: dict[tuple[int, int], Moment] = {}
    received_ns = captured_ns = 0
    for message in recorded:
        if message.topic.stream != "label" and message.name != camera:
            continue
        went_back = message.received_ns < received_ns - LOOK_AHEAD_NS
        if went_back or message.captured_ns < captured_ns - LOOK_AHEAD_NS:
            received_ns = captured_ns = 0
        complete = message.received_ns - LOOK_AHEAD_NS
        for key in sorted(waiting):
            if received_ns and waiting[key][0].received_ns > complete:
                break
            yield from _captured(waiting.pop(key), camera, on_unreadable)
        received_ns = max(received_ns, message.received_ns)
        captured_ns = max(captured_ns, message.captured_ns)
        waiting.setdefault((message.captured_ns, message.sequence), []).append(message)
    for key in sorted(waiting):
        yield from _captured(waiting[key], camera, on_unreadable)


def _captured(
    moment: Moment, camera: str, on_unreadable: Callable[[MessageError], None]
) -> Iterator[Captured]:
    """The moment of these messages; none where only another camera's labels belong to it."""
    frame: RgbdFrame | None = None
    skeletons: Skeletons | None = None
    labels: list[ObjectPose] = []
    messages: list[Message] = []
    coded = any(recorded.coded is not None for recorded in moment)
    for recorded in moment:
        try:
            messages.append(recorded.message())
        except MessageError as error:
            on_unreadable(error)
    for message in messages:
        match message:
            case RgbdFrame():
                frame = message
            case Skeletons():
                skeletons = message
            case ObjectPose(camera=seen_by) if seen_by == camera:
                labels.append(message)
    if frame is None and skeletons is None and not labels:
        return
    yield Captured(
        time_ns=messages[0].time_ns,
        time_uncertainty_ns=0 if frame is None else frame.time_uncertainty_ns,
        pixels=None if frame is None else partial(_pixels, frame, coded=coded),
        people=None if skeletons is None else skeletons.people,
        labels=tuple(labels),
        convention=None if skeletons is None else skeletons.convention,
    )


def _pixels(frame: RgbdFrame, *, coded: bool) -> Pixels:
    """The pixels of a frame; colour that was H.264 is not encoded yet."""
    colour = raw_colour(frame.colour) if coded else frame.colour
    return Pixels(colour, frame.depth)

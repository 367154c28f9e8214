"""What foreign recordings are read as, and how they become one of Inhand's."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

from inhand_recorder.attachments import attach_mesh
from inhand_recorder.losses import LOSSES_RECORD, LossCounter, format_losses
from inhand_runtime.errors import InhandError
from inhand_runtime.recording import RecordingError, RecordingWriter
from inhand_runtime.recording.copying import written_or_gone
from inhand_runtime.wording import printable
from inhand_schemas.errors import MessageError
from inhand_schemas.keys import Site
from inhand_schemas.messages import Message
from inhand_schemas.topics import AnyTopic

IMPORT_RECORD = "import"
"""The name of the metadata record that says what a recording was made of."""
LONGEST_REASON = 200
"""Number of characters that are shown of what another library says of a damaged file."""


@dataclass(frozen=True)
class ForeignMessage:
    """A message for ``topic`` and ``name``, and when it was received, in nanoseconds since the
    epoch: where nothing says that, when it was captured."""

    topic: AnyTopic
    name: str
    message: Message
    received_ns: int


@contextmanager
def explaining(what: str) -> Iterator[None]:
    """Raise whatever a reader of foreign files raises in a block as an InhandError of one line.

    Nothing but the reader is called in such a block: our own faults are no damaged file.
    """
    try:
        yield
    except Exception as error:
        raise InhandError(f"{what}: {printable(str(error))[:LONGEST_REASON]}") from error


@dataclass
class LeftOut:
    """Number of images that cannot be read, and why the first of them cannot."""

    count: int = 0
    reason: str = ""

    def add(self, reason: str) -> None:
        """Count one."""
        self.count += 1
        self.reason = self.reason or reason


def write_imported(
    output: Path,
    site: Site,
    messages: Iterable[ForeignMessage],
    about: Mapping[str, str],
    on_message: Callable[[], None] = lambda: None,
    meshes: Mapping[str, bytes] | None = None,
) -> dict[str, int]:
    """Write messages, which come in the order of their reception, to a new recording.

    ``about`` says what it was made of; this release is added to it. ``meshes`` are PLY in metres by
    the objects' names, and are attached. Returns the numbers of messages by topic; raises
    RecordingError, also where there are none, and then leaves no file.
    """
    counts: dict[str, int] = {}
    with written_or_gone(output) as writer:
        counter = LossCounter()
        for one in messages:
            if not counts:
                _attach(writer, meshes or {}, one.received_ns)
            _write(writer, site, one, counter)
            topic = f"{one.topic.stream}/{one.name}"
            counts[topic] = counts.get(topic, 0) + 1
            on_message()
        if not counts:
            raise RecordingError("nothing in it can be imported")
        writer.add_metadata(LOSSES_RECORD, format_losses(counter.losses()))
        writer.add_metadata(IMPORT_RECORD, {"version": f"inhand {version('inhand')}", **about})
    return counts


def _attach(writer: RecordingWriter, meshes: Mapping[str, bytes], received_ns: int) -> None:
    for name, data in meshes.items():
        attach_mesh(writer, name, data, received_ns)


def _write(writer: RecordingWriter, site: Site, one: ForeignMessage, counter: LossCounter) -> None:
    key = one.topic.key(site, one.name)
    try:
        payload = one.topic.encode(one.message)  # type: ignore[arg-type]
        one.topic.decode(payload)
    except MessageError as error:
        raise RecordingError(f"{key}, captured at {one.message.time_ns}: {error}") from None
    writer.write(
        key,
        payload,
        received_ns=one.received_ns,
        captured_ns=one.message.time_ns,
        sequence=one.message.sequence,
    )
    counter.count(key, one.message.sequence)

"""What is left of a chunk that was damaged or cut off: each message proves itself, or does not."""

import re
from dataclasses import dataclass

from inhand_runtime.recording.checksums import Checksums
from mcap.records import (
    Channel,
    McapRecord,
    Message,
    Schema,
)

from inhand_recorder.records import length_at, message_head, record_at

# The start of a schema, channel or message within a chunk.
_INNER_ANCHOR = re.compile(rb"(?=[\x03\x04\x05][\s\S]{5}\x00\x00\x00)")


@dataclass
class Remains:
    """What is left of a chunk whose own checksum does not hold.

    ``broken`` are heads of messages that a checksum contradicts, or whose end is not where it
    should be; ``cut_off`` is the head of the one in which the data ends. Both are without payload.
    """

    records: tuple[McapRecord, ...] = ()
    doubtful: tuple[Message, ...] = ()
    broken: tuple[Message, ...] = ()
    cut_off: tuple[Message, ...] = ()
    unread_bytes: int = 0

    @property
    def messages(self) -> bool:
        return bool(self.doubtful) or any(isinstance(one, Message) for one in self.records)


def remains_of(data: bytes, checksums: Checksums, times: tuple[int, int]) -> Remains:
    """Walk a chunk's records, and past what is broken to the next one that proves itself.

    A message proves itself by its checksum, where the file has any, and else by a time of reception
    that lies within the chunk's.
    """
    proved: list[McapRecord] = []
    doubtful: list[Message] = []
    broken: list[Message] = []
    cut_off: tuple[Message, ...] = ()
    unread = offset = 0
    while offset < len(data):
        record = record_at(data, offset)
        if isinstance(record, Message) and _proves_itself(record, checksums, times):
            (proved if checksums else doubtful).append(record)
            offset += length_at(data, offset)
        elif isinstance(record, Schema | Channel):
            proved.append(record)
            offset += length_at(data, offset)
        else:
            following = _next_inner(data, offset, checksums, times)
            head = message_head(data, offset)
            if head is not None and times[0] <= head.log_time <= times[1]:
                if record is None and following == len(data):
                    cut_off = (head,)
                else:
                    broken.append(head)
            unread += following - offset
            offset = following
    return Remains(tuple(proved), tuple(doubtful), tuple(broken), cut_off, unread)


def _next_inner(data: bytes, offset: int, checksums: Checksums, times: tuple[int, int]) -> int:
    """Where the next record of a damaged chunk is that proves itself; its end where none does."""
    record = record_at(data, offset)
    if isinstance(record, Message):
        # A payload alone may be damaged: then the record behind it stands where its length says.
        behind = offset + length_at(data, offset)
        if behind == len(data) or _stands(data, behind, checksums, times):
            return behind
    for match in _INNER_ANCHOR.finditer(data, offset + 1):
        if _stands(data, match.start(), checksums, times):
            return match.start()
    return len(data)


def _stands(data: bytes, offset: int, checksums: Checksums, times: tuple[int, int]) -> bool:
    """Whether a record begins here: it proves itself, or its head lies within the chunk's times."""
    if _is_inner(record_at(data, offset), checksums, times):
        return True
    head = message_head(data, offset)
    return head is not None and times[0] <= head.log_time <= times[1]


def _is_inner(record: McapRecord | None, checksums: Checksums, times: tuple[int, int]) -> bool:
    if isinstance(record, Message):
        return _proves_itself(record, checksums, times)
    return isinstance(record, Schema | Channel)


def _proves_itself(message: Message, checksums: Checksums, times: tuple[int, int]) -> bool:
    if not checksums:
        return times[0] <= message.log_time <= times[1]
    return checksums.holds(
        message.channel_id,
        message.sequence,
        message.log_time,
        message.publish_time,
        message.data,
    )

"""The attachments of a whole recording, as the meshes of its objects are."""

import re
from collections.abc import Iterable
from pathlib import Path

from inhand_runtime.recording.layout import RecordingError
from inhand_runtime.recording.opening import opening
from inhand_runtime.recording.reading import explaining_damage
from inhand_runtime.recording.writing import RecordingWriter
from mcap.reader import SeekingReader
from mcap.records import Attachment, Header, Metadata
from mcap.writer import MCAP0_MAGIC

from inhand_recorder.records import attachment_is_sound, length_at, record_at

_MESH_NAME = "objects/{}/mesh.ply"
_MESH_TYPE = "model/ply"
"""The name and the type of the attachment that holds an object's mesh."""
_MESH = re.compile(re.escape(_MESH_NAME).replace(re.escape("{}"), r"(\w+)"))


def read_attachments(path: Path) -> list[Attachment]:
    """Read what is attached to a whole recording, without what a checksum contradicts.

    Raises RecordingError for a file that is missing, foreign, cut off or damaged.
    """
    with opening(path), path.open("rb") as file, explaining_damage(path):
        summary = SeekingReader(file).get_summary()
    if summary is None:
        raise RecordingError(f"{path} has no index: `inhand recording recover {path}` writes one")
    if not summary.attachment_indexes:
        return []
    from inhand_recorder.scanning import opened  # for whoever reads: it needs NumPy

    with opened(path) as data, explaining_damage(path):
        offsets = [one.offset for one in summary.attachment_indexes]
        found = [record_at(data, offset) for offset in offsets if attachment_is_sound(data, offset)]
    return [one for one in found if isinstance(one, Attachment)]


def first_attachments(path: Path) -> list[Attachment]:
    """Read what is attached at the begin of a recording in any state, as a recorder attaches
    meshes, without what a checksum contradicts; raises RecordingError."""
    found = []
    from inhand_recorder.scanning import opened

    with opened(path) as data:
        offset = len(MCAP0_MAGIC)
        while isinstance(record := record_at(data, offset), Header | Metadata | Attachment):
            if isinstance(record, Attachment) and attachment_is_sound(data, offset):
                found.append(record)
            offset += length_at(data, offset)
    return found


def copy_attachments(writer: RecordingWriter, path: Path) -> None:
    """Attach what is attached to a whole recording to a copy of it; raises RecordingError."""
    attach(writer, read_attachments(path))


def attach(writer: RecordingWriter, attachments: Iterable[Attachment]) -> None:
    """Attach to a recording what others have attached; raises RecordingError."""
    for one in attachments:
        writer.add_attachment(one.name, one.media_type, one.data, received_ns=one.log_time)


def attach_mesh(writer: RecordingWriter, name: str, ply: bytes, received_ns: int) -> None:
    """Attach an object's mesh, a PLY file in metres; raises RecordingError."""
    writer.add_attachment(_MESH_NAME.format(name), _MESH_TYPE, ply, received_ns=received_ns)


def meshes_in(attachments: list[Attachment]) -> dict[str, bytes]:
    """Return the meshes of objects among attachments, PLY in metres, by the objects' names."""
    named = ((_MESH.fullmatch(one.name), one.data) for one in attachments)
    return {match[1]: data for match, data in named if match}

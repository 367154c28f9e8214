"""Says in each file by what it was written, and who published what is in it."""

import contextlib
import importlib.metadata
import json
from collections.abc import Mapping
from pathlib import Path

from inhand_runtime.object_meshes import MeshError, mesh_of_model, model_files
from inhand_runtime.settings import Settings, load_rig_file
from inhand_schemas.messages import Health

from inhand_recorder.settings import RecorderSettings

RECORDER_RECORD = "recorder"
"""The name of the metadata record, first in each file of a recorder, that says by what it was
written."""
PUBLISHERS_RECORD = "publishers"
"""The name of the metadata record that says which instance, or instances, published on each key."""
OBJECTS_RECORD = "objects"
"""The name of the metadata record that says of which objects poses came, and what is known of
each."""
NO_MODEL = "no model of it on the recorder's host"
MOST_PUBLISHERS = 10_000
"""Number of keys whose publishers, and of objects whose names, are remembered."""
MOST_OF_ONE_KEY = 16
"""Number of publishers of one key that are remembered, the first ones."""


def with_publisher(publishers: str, more: str) -> str:
    """Return the publishers of a key, as the record says them, with those of another such value;
    a key may have several, as labels of one object in the cameras of a rig."""
    names = [*filter(None, publishers.split(", ")), *filter(None, more.split(", "))]
    return ", ".join(list(dict.fromkeys(names))[:MOST_OF_ONE_KEY])


class Provenance:
    """What a recorder knows of where its files come from, and of what objects they tell."""

    def __init__(self, settings: Settings[RecorderSettings]) -> None:
        """Raises SettingsError where the settings' file cannot be read any more."""
        # Where the folder lies says nothing of what is recorded, and may be private.
        chosen = settings.service.model_dump(mode="json", exclude={"folder"})
        self._recorder = {
            "software": f"inhand {importlib.metadata.version('inhand')}",
            "realm": settings.site.realm,
            "rig": settings.site.rig,
            "recorder": settings.instance,
            "settings": json.dumps(chosen),
        }
        self._publishers: dict[str, str] = {}
        self._models = _models_of(settings.origin.path)
        self._objects: dict[str, str] = {}
        self._meshes: dict[str, bytes] = {}
        self._read_from: dict[Path, tuple[int, int]] = {}

    def hear(self, health: Health) -> None:
        """Take note of who publishes what, from what an instance says of itself."""
        for key, topic in health.topics.items():
            known = key in self._publishers or len(self._publishers) < MOST_PUBLISHERS
            if topic.published and known:
                instance = f"{health.service} {health.instance}"
                self._publishers[key] = with_publisher(self._publishers.get(key, ""), instance)

    def records(self) -> Mapping[str, Mapping[str, str]]:
        """Return the named records of a file that begins or ends now."""
        records: dict[str, Mapping[str, str]] = {RECORDER_RECORD: self._recorder}
        if self._publishers:
            records[PUBLISHERS_RECORD] = dict(sorted(self._publishers.items()))
        if self._objects:
            records[OBJECTS_RECORD] = dict(sorted(self._objects.items()))
        return records

    def follow(self, name: str) -> None:
        """Take note that poses of an object come."""
        if len(self._objects) < MOST_PUBLISHERS:
            self._objects.setdefault(name, NO_MODEL)

    def meshes(self) -> Mapping[str, bytes]:
        """Return the meshes of objects, as PLY files, of those models that are on this host; one
        that was replaced is read anew."""
        for path in self._models:
            with contextlib.suppress(OSError, MeshError):  # then the objects' record says so
                status = path.stat()
                version = status.st_mtime_ns, status.st_size
                if self._read_from.get(path) != version:
                    mesh = mesh_of_model(path)
                    self._read_from[path] = version
                    self._meshes[mesh.name] = mesh.ply
                    self._objects[mesh.name] = f"its model is {path.name}"
        return self._meshes


def _models_of(config: Path | None) -> tuple[Path, ...]:
    """The models that trackers of a settings file follow."""
    if config is None:
        return ()
    return model_files(load_rig_file(config).tracker, config.parent)

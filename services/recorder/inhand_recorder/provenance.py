"""Says in each file by what it was written, and who published what is in it."""

import importlib.metadata
import json
from collections.abc import Mapping

from inhand_runtime.settings import Settings
from inhand_schemas.messages import Health

from inhand_recorder.settings import RecorderSettings

RECORDER_RECORD = "recorder"
"""The name of the metadata record, first in each file of a recorder, that says by what it was
written."""
PUBLISHERS_RECORD = "publishers"
"""The name of the metadata record that says which instance published on each key."""
MOST_PUBLISHERS = 10_000
"""Number of keys whose publishers are remembered."""


class Provenance:
    """What a recorder knows of where its files come from."""

    def __init__(self, settings: Settings[RecorderSettings]) -> None:
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

    def hear(self, health: Health) -> None:
        """Take note of who publishes what, from what an instance says of itself."""
        for key, topic in health.topics.items():
            known = key in self._publishers or len(self._publishers) < MOST_PUBLISHERS
            if topic.published and known:
                self._publishers[key] = f"{health.service} {health.instance}"

    def records(self) -> Mapping[str, Mapping[str, str]]:
        """Return the named records of a file that begins or ends now."""
        records: dict[str, Mapping[str, str]] = {RECORDER_RECORD: self._recorder}
        if self._publishers:
            records[PUBLISHERS_RECORD] = dict(sorted(self._publishers.items()))
        return records

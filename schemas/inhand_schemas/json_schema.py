"""The contract as JSON Schema, for other languages and for recordings.

``python -m inhand_schemas.json_schema FOLDER`` writes one file a message type.
"""

import json
import sys
from inspect import cleandoc
from pathlib import Path
from typing import Any

import msgspec

from inhand_schemas.topics import TOPICS


def json_schema(message_type: type[msgspec.Struct]) -> dict[str, Any]:
    """The JSON Schema (2020-12) of a message type; bytes appear as base64 strings."""
    schema = msgspec.json.schema(message_type)
    for definition in schema["$defs"].values():
        definition["description"] = cleandoc(definition["description"])
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}


def json_schemas() -> dict[str, dict[str, Any]]:
    """The schemas of all message types by name."""
    types = {topic.message_type for topic in TOPICS.values()}
    return {t.__name__: json_schema(t) for t in sorted(types, key=lambda t: t.__name__)}


def main(folder: Path) -> None:
    """Write every schema to ``folder``."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, schema in json_schemas().items():
        (folder / f"{name}.v1.json").write_text(json.dumps(schema, indent=2) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))

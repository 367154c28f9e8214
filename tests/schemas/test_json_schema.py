"""The contract for other languages is the contract."""

import base64
import json
from pathlib import Path
from typing import Any

import msgpack
import pytest
from inhand_schemas import json_schema
from inhand_schemas.topics import TOPICS
from jsonschema import Draft202012Validator
from make_golden import GOLDEN

EXPORTED = Path(__file__).parents[2] / "schemas" / "json"
TYPES = sorted({topic.message_type.__name__ for topic in TOPICS.values()})


def exported(name: str) -> dict[str, Any]:
    schema: dict[str, Any] = json.loads((EXPORTED / f"{name}.v1.json").read_text())
    return schema


def test_the_exported_files_are_up_to_date(tmp_path: Path) -> None:
    json_schema.main(tmp_path)
    fresh = {path.name: path.read_text() for path in tmp_path.iterdir()}
    assert fresh == {path.name: path.read_text() for path in EXPORTED.iterdir()}, (
        "run `python -m inhand_schemas.json_schema schemas/json`"
    )


@pytest.mark.parametrize("name", TYPES)
def test_an_exported_schema_is_valid_and_accepts_the_golden_message(name: str) -> None:
    Draft202012Validator.check_schema(exported(name))
    validator = Draft202012Validator(exported(name))
    validator.validate(json.loads((GOLDEN / f"{name}.v1.json").read_text()))
    assert not validator.is_valid({})


@pytest.mark.parametrize("name", TYPES)
def test_an_exported_schema_accepts_what_bare_msgpack_reads(name: str) -> None:
    plain = msgpack.unpackb((GOLDEN / f"{name}.v1.msgpack").read_bytes())
    as_json = json.loads(json.dumps(plain, default=lambda data: base64.b64encode(data).decode()))
    Draft202012Validator(exported(name)).validate(as_json)

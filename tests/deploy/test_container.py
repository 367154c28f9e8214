"""The container's files name what there is."""

import json
import re
import tomllib
from itertools import chain
from pathlib import Path

import inhand.__main__ as program
from inhand.deployment import deploy_folder

CHECKOUT = Path(__file__).parents[2]
DOCKERFILE = (deploy_folder() / "container/Dockerfile").read_text(encoding="utf-8")
COMPOSE = (deploy_folder() / "container/compose.yaml").read_text(encoding="utf-8")


def test_the_image_is_made_of_files_and_extras_that_there_are() -> None:
    copied = re.findall(r"^COPY (?!--from)(.+) \S+$", DOCKERFILE, re.MULTILINE)
    names = list(chain.from_iterable(line.split() for line in copied))
    assert "inhand" in names
    assert [name for name in names if not (CHECKOUT / name).exists()] == []
    (extras,) = re.findall(r"^ARG EXTRAS=(\S+)$", DOCKERFILE, re.MULTILINE)
    project = tomllib.loads((CHECKOUT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert set(extras.split(",")) <= set(project["optional-dependencies"])


def test_the_image_and_its_services_run_verbs_of_the_command_line() -> None:
    (usual,) = re.findall(r"^CMD (\[.+\])$", DOCKERFILE, re.MULTILINE)
    commands = re.findall(r"^    command: \[(\w+)", COMPOSE, re.MULTILINE)
    checks = re.findall(r"^      test: \[CMD, inhand, (\w+)", COMPOSE, re.MULTILINE)
    assert checks == ["status"]
    assert {json.loads(usual)[0], *commands, *checks} <= {*program.DAEMONS, *program.VERBS}


def test_the_image_runs_as_a_user_who_owns_what_it_writes() -> None:
    assert "\nUSER inhand\n" in DOCKERFILE
    (volumes,) = re.findall(r"^VOLUME (\[.+\])$", DOCKERFILE, re.MULTILINE)
    written = re.findall(r"(?:STATE|CACHE)_DIRECTORY=(\S+)", DOCKERFILE)
    assert written == json.loads(volumes)
    assert all(f":{folder}\n" in COMPOSE for folder in written)

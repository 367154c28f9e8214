"""The container's files name what there is, and are right for those who read them."""

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from importlib.util import find_spec
from itertools import chain
from pathlib import Path

import pytest

import inhand.__main__ as program
from inhand.deployment import deploy_folder

CHECKOUT = Path(__file__).parents[2]
FOLDER = deploy_folder() / "container"
DOCKERFILE = (FOLDER / "Dockerfile").read_text(encoding="utf-8")
COMPOSE = (FOLDER / "compose.yaml").read_text(encoding="utf-8")
COPIED = list(
    chain.from_iterable(
        line.split() for line in re.findall(r"^COPY (?!--from)(.+) \S+$", DOCKERFILE, re.MULTILINE)
    )
)
"""Names of the checkout's files and folders that the image is made of."""
PROFILES = sorted(set(re.findall(r"^    profiles: \[(\w+)\]$", COMPOSE, re.MULTILINE)))

needs_compose = pytest.mark.skipif(
    shutil.which("docker-compose") is None and "DOCKER_COMPOSE_REQUIRED" not in os.environ,
    reason="there is no docker-compose",
)


def test_the_image_is_made_of_files_and_extras_that_there_are() -> None:
    assert "inhand" in COPIED
    assert [name for name in COPIED if not (CHECKOUT / name).exists()] == []
    (extras,) = re.findall(r"^ARG EXTRAS=(\S+)$", DOCKERFILE, re.MULTILINE)
    project = tomllib.loads((CHECKOUT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert set(extras.split(",")) <= set(project["optional-dependencies"])


@pytest.mark.parametrize(("extras", "asked"), [("oak,pose", ".[oak,pose]"), ("", ".")])
def test_the_image_is_made_with_the_extras_that_are_named_or_none(extras: str, asked: str) -> None:
    (word,) = re.findall(r'pip install .+ (".+") ', DOCKERFILE)
    done = subprocess.run(
        ["sh", "-c", f"printf %s {word}"], env={"EXTRAS": extras}, capture_output=True, check=True
    )
    assert done.stdout.decode() == asked


def test_whoever_builds_the_image_is_sent_what_it_is_made_of_and_nothing_else() -> None:
    lines = (CHECKOUT / ".dockerignore").read_text(encoding="utf-8").splitlines()
    sent = {line.removeprefix("!/") for line in lines if line.startswith("!")}
    assert "*" in lines
    assert sent == set(COPIED)


def test_the_image_and_its_services_run_verbs_of_the_command_line() -> None:
    (usual,) = re.findall(r"^CMD (\[.+\])$", DOCKERFILE, re.MULTILINE)
    commands = re.findall(r"^    command: \[(\w+)", COMPOSE, re.MULTILINE)
    checks = re.findall(r"^      test: \[CMD, inhand, (\w+)", COMPOSE, re.MULTILINE)
    assert checks == ["status"]
    assert {json.loads(usual)[0], *commands, *checks} <= {*program.DAEMONS, *program.VERBS}


def test_the_image_runs_as_a_user_who_owns_what_it_writes() -> None:
    (number,) = re.findall(r"useradd .*--uid (\d+)", DOCKERFILE)
    assert f"\nUSER {number}:{number}\n" in DOCKERFILE
    (volumes,) = re.findall(r"^VOLUME (\[.+\])$", DOCKERFILE, re.MULTILINE)
    written = re.findall(r"(?:STATE|CACHE)_DIRECTORY=(\S+)", DOCKERFILE)
    assert written == json.loads(volumes)
    assert f"--owner inhand --group inhand --mode 0750 {' '.join(written)}\n" in DOCKERFILE
    assert all(f":{folder}\n" in COMPOSE for folder in written)


def test_what_is_stripped_in_the_image_is_installed_and_read_there() -> None:
    script = (FOLDER / "slim.sh").read_text(encoding="utf-8")
    (stripped,) = re.findall(r"^for package in (.+); do$", script, re.MULTILINE)
    (read,) = re.findall(r"-c 'import (.+)'$", script, re.MULTILINE)
    assert {name.partition(".")[0] for name in read.split(", ")} == set(stripped.split())
    assert [name for name in stripped.split() if find_spec(name) is None] == []


def test_the_dockerfile_is_as_its_linter_wants_it() -> None:
    hadolint = Path(sys.executable).with_name("hadolint")
    done = _run(hadolint, FOLDER / "Dockerfile")
    assert (done.returncode, done.stdout) == (0, "")


def test_the_compose_file_is_of_the_specification() -> None:
    schema = ("--builtin-schema", "vendor.compose-spec")
    done = _run(sys.executable, "-m", "check_jsonschema", *schema, FOLDER / "compose.yaml")
    assert done.returncode == 0, done.stdout


@needs_compose
@pytest.mark.parametrize("profile", ["", *PROFILES])
def test_compose_reads_its_file_with_each_profile(profile: str) -> None:
    options = ["--profile", profile] if profile else []
    done = _run("docker-compose", *options, "config", "--quiet", folder=FOLDER)
    assert done.returncode == 0, done.stderr


def _run(*command: str | Path, folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(part) for part in command], cwd=folder, capture_output=True, text=True, check=False
    )

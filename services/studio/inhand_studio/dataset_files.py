"""What a dataset's folder holds, by the names that a page lists."""

from collections.abc import Iterable
from pathlib import Path

SUFFIXES = (".mcap", ".mcap.part")
LABELLED_COPY = ".labelled.mcap"


def find_recordings(
    dataset: Path, also: Path | None = None, *, labelled_copies: bool = True
) -> dict[str, Path]:
    """Return the recordings of a dataset's folder by their names, and the one given besides."""
    found = sorted(
        path
        for path in (dataset / "recordings").glob("*")
        if path.name.endswith(SUFFIXES)
        and (labelled_copies or not path.name.endswith(LABELLED_COPY))
    )
    named = {recording_name(path, dataset): path for path in found}
    if also is not None:
        named.setdefault(recording_name(also, dataset), also)
    return named


def find_objects(dataset: Path) -> dict[str, Path]:
    """Return the folders of a dataset's objects by name; one that is being made is hidden."""
    found = sorted((dataset / "objects").glob("[!.]*/object.toml"))
    return {path.parent.name: path.parent for path in found}


def find_models(dataset: Path, others: Iterable[Path]) -> list[Path]:
    """Return the models in a dataset's folder and its ``models``, the newest first, then others."""
    own = [*dataset.glob("*.model"), *dataset.glob("models/*.model")]
    own.sort(key=lambda path: -path.stat().st_mtime)
    return list(dict.fromkeys([*own, *others]))


def recording_name(path: Path, dataset: Path) -> str:
    """Return what a recording is listed as: its file's name, or its path where it is elsewhere."""
    folder = dataset / "recordings"
    return path.name if path.parent.absolute() == folder.absolute() else str(path)

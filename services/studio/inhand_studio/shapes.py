"""The shapes of objects that a studio can know: of its dataset, or of the rig's models."""

import threading
from collections.abc import Sequence
from pathlib import Path

from inhand_runtime.errors import InhandError
from inhand_tracker.model.model_file import load_model
from inhand_tracker.shape.shape import ObjectShape, load_shape


class Shapes:
    """Finds objects' shapes by their names; thread-safe.

    A shape comes from ``objects/NAME`` of the dataset, and is read again when that changes, else
    from one of the models, which are files of this machine.
    """

    def __init__(self, dataset: Path, models: Sequence[Path] = ()) -> None:
        self._objects = dataset / "objects"
        self._models = tuple(models)
        self._lock = threading.Lock()
        self._read: dict[str, tuple[int, ObjectShape | None, str | None]] = {}
        self._of_models: dict[str, ObjectShape] | None = None
        self._unread: list[str] = []

    def find(self, name: str) -> tuple[ObjectShape | None, str | None]:
        """Return an object's shape, or None and a sentence on why there is none."""
        with self._lock:
            changed_ns = _changed_ns(self._objects / name)
            if changed_ns is not None:
                if name not in self._read or self._read[name][0] != changed_ns:
                    self._read[name] = (changed_ns, *self._loaded(name))
                _, shape, why = self._read[name]
                return shape, why
            if self._of_models is None:
                self._of_models = self._load_models()
            shape = self._of_models.get(name)
        if shape is not None:
            return shape, None
        return None, (
            f"There is no mesh of {name} in {self._objects}: its axes are drawn. Copy its folder "
            "from where it was learned, or make it with `inhand object new`."
            + "".join(f" A model of the rig was not read: {error}." for error in self._unread)
        )

    def _loaded(self, name: str) -> tuple[ObjectShape | None, str | None]:
        try:
            return load_shape(self._objects / name), None
        except InhandError as error:
            return None, f"The mesh of {name} cannot be used, and its axes are drawn: {error}."

    def _load_models(self) -> dict[str, ObjectShape]:
        shapes = {}
        for path in self._models:
            try:
                shape = load_model(path).shape
                shapes[shape.name] = shape
            except InhandError as error:
                self._unread.append(str(error))
        return shapes


def _changed_ns(folder: Path) -> int | None:
    """Return when an object's description was changed; None where there is none."""
    try:
        return (folder / "object.toml").stat().st_mtime_ns
    except OSError:
        return None

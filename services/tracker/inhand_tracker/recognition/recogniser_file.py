"""A learned recogniser in one file: a zip of NumPy arrays and a JSON description, with checksums.

As a model's file, any zip tool and NumPy can open it, and nothing in it is executed.
"""

import contextlib
import json
import zipfile
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from inhand_tracker.model.model_file import ModelError
from inhand_tracker.recognition.movement_classes import MovementClasses
from inhand_tracker.recognition.pairwise_svm import PairwiseSvm
from inhand_tracker.recognition.presence import Presence
from inhand_tracker.recognition.recogniser import Recogniser

FORMAT = "inhand-recogniser"
VERSION = 4
MEND = "make one with `inhand train --recogniser`"


def save_recogniser(recogniser: Recogniser, path: Path) -> None:
    """Write a recogniser; an existing file is replaced only when all is written."""
    description = {
        "format": FORMAT,
        "version": VERSION,
        "actions": recogniser.actions,
        "temper": recogniser.temper,
        "gamma": recogniser.svm.gamma,
    }
    arrays: dict[str, Any] = {"body_poses": recogniser.body_poses}
    for part, names in _ARRAYS.items():
        arrays |= {f"{part}.{name}": getattr(getattr(recogniser, part), name) for name in names}
    temporary = path.with_name(path.name + ".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with temporary.open("wb") as file:
            np.savez(file, recogniser=np.array(json.dumps(description)), **arrays)
        temporary.replace(path)
    except OSError as error:
        with contextlib.suppress(OSError):
            temporary.unlink()
        raise ModelError(f"cannot write {path}: {error.strerror}") from None


def load_recogniser(path: Path) -> Recogniser:
    """Read a recogniser; raises ModelError for a missing, foreign, newer or damaged file."""
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
            if "recogniser" not in archive:
                raise ModelError(f"{path} is no Inhand recogniser: {MEND}")
            description = json.loads(str(archive["recogniser"]))
            if description["format"] != FORMAT or description["version"] != VERSION:
                raise ModelError(
                    f"{path} is {description['format']} version {description['version']}, and this "
                    f"release reads {FORMAT} version {VERSION}: update Inhand, or train again"
                )
            arrays = {name: archive[name] for name in archive.files}
        parts = {
            part: {name: arrays[f"{part}.{name}"] for name in names}
            for part, names in _ARRAYS.items()
        }
        return Recogniser(
            tuple(description["actions"]),
            arrays["body_poses"],
            PairwiseSvm(gamma=float(description["gamma"]), **parts["svm"]),
            MovementClasses(**parts["movements"]),
            float(description["temper"]),
            Presence(**parts["presence"]),
        )
    except ModelError:
        raise
    except OSError as error:
        raise ModelError(f"cannot read {path}: {error.strerror or error}") from None
    except Exception as error:  # noqa: BLE001 - a reader of damaged files may raise anything
        if not zipfile.is_zipfile(path):
            raise ModelError(f"{path} is no Inhand recogniser: {MEND}") from None
        raise ModelError(f"{path} is damaged ({error}): copy it again, or {MEND}") from None


_ARRAYS = {
    "svm": tuple(field.name for field in fields(PairwiseSvm) if field.name != "gamma"),
    "movements": tuple(field.name for field in fields(MovementClasses)),
    "presence": tuple(field.name for field in fields(Presence)),
}

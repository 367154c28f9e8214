"""A learned recogniser in one file, as a model is (``archive``)."""

from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any

from inhand_tracker.model.archive import ArchiveKind, Arrays, read_archive, write_archive
from inhand_tracker.recognition.arm_courses import ArmCourses
from inhand_tracker.recognition.movement_classes import MovementClasses
from inhand_tracker.recognition.pairwise_svm import PairwiseSvm
from inhand_tracker.recognition.presence import Presence
from inhand_tracker.recognition.recogniser import Recogniser

MEND = "make one with `inhand train --recogniser`"
NOUNS = ("inhand-recogniser version", "inhand-recogniser version")
RECOGNISER_FILE = ArchiveKind(
    "recogniser", "inhand-recogniser", 4, "Inhand recogniser", NOUNS, make=MEND, make_again=MEND
)
_ARRAYS = {
    "svm": tuple(field.name for field in fields(PairwiseSvm) if field.name != "gamma"),
    "movements": tuple(f.name for f in fields(MovementClasses) if f.name != "arms"),
    "presence": tuple(field.name for field in fields(Presence)),
}
_COURSES = tuple(field.name for field in fields(ArmCourses))


def save_recogniser(recogniser: Recogniser, path: Path | str) -> None:
    """Write a recogniser; an existing file is replaced only when all is written.

    Raises ModelError.
    """
    description = {
        "actions": recogniser.actions,
        "temper": recogniser.temper,
        "gamma": recogniser.svm.gamma,
    }
    arrays: Arrays = {"body_poses": recogniser.body_poses}
    for part, names in _ARRAYS.items():
        arrays |= _named(part, getattr(recogniser, part), names)
    if recogniser.movements.arms is not None:
        arrays |= _named("courses", recogniser.movements.arms, _COURSES)
    write_archive(RECOGNISER_FILE, path, description, arrays)


def load_recogniser(path: Path | str) -> Recogniser:
    """Read a recogniser; raises ModelError for a missing, foreign, newer or damaged file."""
    return read_archive(RECOGNISER_FILE, path, _assemble)


def _named(part: str, holder: object, names: Sequence[str]) -> Arrays:
    return {f"{part}.{name}": getattr(holder, name) for name in names}


def _part(part: str, names: Sequence[str], arrays: Arrays) -> Arrays:
    return {name: arrays[f"{part}.{name}"] for name in names}


def _assemble(description: dict[str, Any], arrays: Arrays) -> Recogniser:
    parts = {part: _part(part, names, arrays) for part, names in _ARRAYS.items()}
    arms = None
    # Files of older releases have none.
    if "courses.observations" in arrays:
        arms = ArmCourses(**_part("courses", _COURSES, arrays))
    return Recogniser(
        actions=tuple(description["actions"]),
        body_poses=arrays["body_poses"],
        svm=PairwiseSvm(gamma=float(description["gamma"]), **parts["svm"]),
        movements=MovementClasses(**parts["movements"], arms=arms),
        temper=float(description["temper"]),
        presence=Presence(**parts["presence"]),
    )

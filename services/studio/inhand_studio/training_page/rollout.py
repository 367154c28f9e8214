"""Puts a model into a running rig: into the file that a tracker's settings name, which it loads."""

import shutil
from dataclasses import dataclass
from pathlib import Path

from inhand_runtime.daemon import Daemon
from inhand_runtime.errors import InhandError
from inhand_runtime.settings import instance_settings, load_rig_file
from inhand_schemas.procedures import RELOAD, ReloadRequest
from inhand_tracker.model.model import ModelError
from inhand_tracker.model.model_file import load_model
from inhand_tracker.settings import TrackerSettings

LOADING_S = 20.0
"""Seconds in which a tracker loads its models on a busy machine."""
BEFORE = ".before"
"""What the name of the model that was there before ends in."""


@dataclass(frozen=True)
class Place:
    """A model's file that a tracker's settings name, and the object that it is of, if any."""

    tracker: str
    file: Path
    object_name: str | None

    @property
    def title(self) -> str:
        """What it is called on the page."""
        return f"{self.tracker}: {self.file.name} ({self.object_name or 'not there yet'})"


def places_of(config: Path | None) -> list[Place]:
    """Return where models go, by a rig's settings file; raises SettingsError."""
    rig_file = load_rig_file(config)
    places = []
    for name in rig_file.tracker:
        chosen = instance_settings(rig_file, config, "tracker", TrackerSettings, name).service
        for file in chosen.model_files:
            places.append(Place(name, file, _object_of(file)))
    return places


def roll_out(model: Path, place: Place, daemon: Daemon) -> str:
    """Put a model in a place and let the tracker load it; returns what came of it.

    What was there is kept beside. Raises InhandError, and puts that back, where the tracker cannot
    use the new one.
    """
    before = place.file.with_name(place.file.name + BEFORE)
    try:
        was_there = place.file.exists()
        if was_there:
            shutil.copy2(place.file, before)
        _copy_whole(model, place.file)
        replies = daemon.ask(RELOAD, ReloadRequest(tracker=place.tracker), LOADING_S)
        problem = next((one.problem for one in replies if one.problem is not None), None)
        if problem is not None and was_there:
            _copy_whole(before, place.file)
    except OSError as error:
        raise InhandError(f"cannot write {place.file}: {error.strerror}") from None
    if problem is not None:
        raise InhandError(f"the tracker {place.tracker} stays with what it had: {problem}")
    if not replies:
        return (
            f"{place.file} is written; {place.tracker} does not run, and will load it at its start"
        )
    return f"{place.tracker} follows {', '.join(replies[0].objects)} by {place.file} now"


def how_to_add(model: Path, object_name: str) -> str:
    """Return what to write into the rig's settings where no tracker has a place for the model."""
    return (
        "No tracker in the rig's settings has a place for it. Write there, and start the rig anew: "
        f'[tracker.{object_name}] camera = "NAME" model = "{model.absolute()}"'
    )


def _object_of(file: Path) -> str | None:
    try:
        return load_model(file).shape.name
    except ModelError:  # not there, or of another release: it is to be replaced
        return None


def _copy_whole(source: Path, target: Path) -> None:
    part = target.with_name(target.name + ".part")
    shutil.copyfile(source, part)
    part.replace(target)

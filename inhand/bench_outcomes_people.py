"""People who are simulated and tracked from their images, for ``inhand bench outcomes``.

Whatever of them stands in the folder already is used again.
"""

import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from inhand_lab.people.person import USUAL_PEOPLE, sample_person
from inhand_lab.world.interactions import INTERACTIONS
from inhand_runtime.errors import InhandError

TAUGHT_BY = 5150
"""Seed of the people who teach the models."""
TEACHERS = 3
TAUGHT_FRAMES = 300
FRAMES = 360
SUFFIX = "_retrack"
ESTIMATED = "estimated"
"""Subfolder of the people with skeletons that are estimated from their images, and of what is
learned from these and tracked with them."""


@dataclass(frozen=True)
class Taught:
    """What a rig has learned: the ``models`` of objects by interaction, and the ``recogniser`` of
    these interactions."""

    models: Mapping[str, Path]
    recogniser: Path

    @property
    def files(self) -> list[Path]:
        """The files of the models."""
        return list(self.models.values())


def teach(folder: Path, *, estimated: bool = False) -> Taught:
    """The models of all objects and their recogniser, learned where they are missing; raises
    InhandError.

    A rig is taught with the skeletons that it will see: a Kinect's, or ``estimated`` ones.
    """
    taught = _people(folder, TAUGHT_BY, TEACHERS, TAUGHT_FRAMES, estimated=estimated)
    at = taught.parent
    models = {}
    for interaction, done in INTERACTIONS.items():
        name = done.object_model().name
        models[interaction] = at / f"{name}.model"
        if not models[interaction].exists():
            _inhand("train", taught, "--object", name, "-o", models[interaction])
    recogniser = at / "all.recogniser"
    if not recogniser.exists():
        _inhand("train", taught, "-o", recogniser, "--recogniser", "--models", *models.values())
    return Taught(models, recogniser)


def tracked_people(
    folder: Path, seed: int, participants: int, taught: Taught, *, estimated: bool
) -> Path:
    """The folder of the tracked recordings of a seed's people, with a Kinect's skeletons or with
    ones that were estimated from their images; raises InhandError."""
    recordings = recorded_people(folder, seed, participants, estimated=estimated)
    tracked = taught.recogniser.with_name(f"tracked_{seed}")
    for number in range(participants):
        paths = [path for path in recordings if path.stem.endswith(f"_p{number:02}")]
        track(taught, paths, tracked, left_handed=is_left_handed(seed, number))
    return tracked


def recorded_people(
    folder: Path, seed: int, participants: int, *, estimated: bool = False
) -> list[Path]:
    """The recordings of a seed's people with all objects; raises InhandError."""
    people = _people(folder, seed, participants, FRAMES, estimated=estimated)
    return sorted((people / "recordings").glob("*.mcap"))


def _people(folder: Path, seed: int, participants: int, frames: int, *, estimated: bool) -> Path:
    """The dataset of a seed's people, which is made where it is missing."""
    people = folder / f"people_{seed}"
    if not (people / "dataset.toml").exists():
        numbers = {"participants": participants, "seed": seed, "frames": frames}
        wanted = (part for name, one in numbers.items() for part in (f"--{name}", str(one)))
        _inhand("simulate", people, *wanted)
    return _estimated(people, folder / ESTIMATED / people.name) if estimated else people


def _estimated(people: Path, output: Path) -> Path:
    """The same people with skeletons that are estimated from their images."""
    recordings = output / "recordings"
    recordings.mkdir(parents=True, exist_ok=True)
    for path in sorted((people / "recordings").glob("*.mcap")):
        if not (recordings / path.name).exists():
            _inhand("recording", "skeletons", "--replace", "-o", recordings / path.name, path)
    shutil.copytree(people / "objects", output / "objects", dirs_exist_ok=True)
    shutil.copy(people / "dataset.toml", output)
    return output


def track(taught: Taught, recordings: Sequence[Path], folder: Path, *, left_handed: bool) -> None:
    """Track what is recorded of somebody with all that a rig was taught; raises InhandError."""
    config = _settings_of(taught, left_handed=left_handed)
    _inhand("recording", "retrack", "--config", config, "-o", folder, *recordings)


def is_left_handed(seed: int, number: int) -> bool:
    """Whether one of a seed's people is."""
    return sample_person(seed, number, USUAL_PEOPLE).handedness == "left"


def _settings_of(taught: Taught, *, left_handed: bool) -> Path:
    """The file of a tracker's settings for somebody, as they would write it."""
    hand = "left" if left_handed else "right"
    config = taught.recogniser.with_suffix(f".{hand}.toml")
    models = ", ".join(f'"{path.name}"' for path in taught.files)
    lines = (
        f"[tracker.{SUFFIX[1:]}]",
        f"models = [{models}]",
        f'recogniser = "{taught.recogniser.name}"',
        f"left_handed = {str(left_handed).lower()}",
    )
    config.write_text("\n".join(lines) + "\n")
    return config


def _inhand(*arguments: str | Path) -> None:
    command = [sys.executable, "-m", "inhand", *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise InhandError(done.stderr.strip())

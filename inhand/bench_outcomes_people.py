"""People who are simulated and tracked from their images, for ``inhand bench outcomes``.

Whatever of them stands in the folder already is used again.
"""

import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

from inhand_lab.people.person import USUAL_PEOPLE, sample_person
from inhand_lab.world.interactions import INTERACTIONS
from inhand_runtime.errors import InhandError

TAUGHT_BY = 5150
"""Seed of the people who teach the models."""
TEACHERS = 3
TAUGHT_FRAMES = 300
FRAMES = 360
SUFFIX = "_retrack"


def taught_models(folder: Path) -> dict[str, Path]:
    """The models by interaction, learned where they are missing; raises InhandError."""
    taught = folder / f"people_{TAUGHT_BY}"
    _simulate(taught, TAUGHT_BY, TEACHERS, TAUGHT_FRAMES)
    models = {}
    for interaction, done in INTERACTIONS.items():
        name = done.object_model().name
        models[interaction] = folder / f"{name}.model"
        if not models[interaction].exists():
            _inhand("train", taught, "--object", name, "-o", models[interaction])
    return models


def tracked_people(
    folder: Path, seed: int, participants: int, models: Mapping[str, Path], *, estimated: bool
) -> Path:
    """The folder of the tracked recordings of a seed's people, with a Kinect's skeletons or with
    ones that were estimated from their images; raises InhandError."""
    people = folder / f"people_{seed}"
    tracked = folder / (f"tracked_estimated_{seed}" if estimated else f"tracked_{seed}")
    _simulate(people, seed, participants, FRAMES)
    for number in range(participants):
        left_handed = sample_person(seed, number, USUAL_PEOPLE).handedness == "left"
        for interaction, model in models.items():
            path = people / "recordings" / f"{interaction}_p{number:02}.mcap"
            if (tracked / path.name).exists():
                continue
            config = _settings(model, left_handed=left_handed)
            with TemporaryDirectory(dir=folder) as name:
                source = Path(name) / path.name if estimated else path
                if estimated:
                    _inhand("recording", "skeletons", "--replace", "-o", source, path)
                _inhand("recording", "retrack", "--config", config, "-o", tracked, source)
    return tracked


def _settings(model: Path, *, left_handed: bool) -> Path:
    """The settings of a tracker for somebody, as they would write them."""
    config = model.with_suffix(".left.toml" if left_handed else ".right.toml")
    hand = str(left_handed).lower()
    config.write_text(f'[tracker.{SUFFIX[1:]}]\nmodel = "{model.name}"\nleft_handed = {hand}\n')
    return config


def _simulate(out: Path, seed: int, participants: int, frames: int) -> None:
    if not (out / "dataset.toml").exists():
        numbers = {"participants": participants, "seed": seed, "frames": frames}
        wanted = (part for name, one in numbers.items() for part in (f"--{name}", str(one)))
        _inhand("simulate", out, *wanted)


def _inhand(*arguments: str | Path) -> None:
    command = [sys.executable, "-m", "inhand", *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        raise InhandError(f"inhand {arguments[0]}: {done.stderr.strip()}")

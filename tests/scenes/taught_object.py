"""A kettle that nobody trained: made, labelled on the page by a person, learned, and tracked live.

    python tests/scenes/taught_object.py

A script makes the kettle's mesh, and simulated people pour from it. In real Chromium, through the
page's own controls, somebody labels three of them by a dozen keyframes each, which are the truth
with 5 mm and 3° of inaccuracy. A model is learned from these labels, and another from the truth;
both follow a fourth person live, whom neither knows. All are right-handed, which is what a tracker
takes people for.
"""

import argparse
import itertools
import sys
import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import trimesh
from browser import chromium, tab
from inhand_lab.datasets.dataset import DatasetEntry
from inhand_lab.datasets.generation import Take, write_takes
from inhand_lab.datasets.new_entry import add_entry
from inhand_lab.labelling.labelled_copy import Labels, labelled_path, write_labels
from inhand_lab.labelling.scene import load_scene
from inhand_lab.motions import pour_cream
from inhand_lab.objects.jug import JUG_BELLY, JUG_HANDLE_REACH, JUG_HEIGHT, SPOUT
from inhand_lab.objects.model import ObjectModel, build_model, tube, turned
from inhand_lab.people.person import sample_person
from inhand_lab.sensing.cameras import KINECT
from inhand_lab.world.interactions import INTERACTIONS, Interaction
from inhand_lab.world.simulation import Simulation, simulate
from inhand_runtime.recording import RecordingWriter, read_recording
from inhand_runtime.recording.copying import copy_message
from inhand_schemas.topics import LABEL
from inhand_tracker.geometry import rotations
from inhand_tracker.shape.shape import load_shape
from labelling_person import LabellingPerson, labelling
from overload import finish, replayed
from running_rig import RunningRig

NAME, INTERACTION = "kettle", "pourKettle"
RATE_HZ = 30
INACCURATE_M, INACCURATE_RAD = 0.005, float(np.deg2rad(3.0))
MOST_KEYFRAMES = 12
STEEL, BLACK, RED = (110, 130, 170), (40, 40, 44), (190, 40, 40)


def kettle() -> ObjectModel:
    """A small kettle in the frame of the jug, whose handle and spout are where it has its own."""
    half = JUG_HEIGHT / 2.0
    outline = [(0.0, -half), (0.048, -half), (0.052, -0.03), (0.046, 0.012), (0.026, 0.034)]
    body = turned([*outline, (0.024, 0.038), (0.008, 0.040), (0.0, 0.040)], 32)
    knob = turned([(0.0, 0.036), (0.009, 0.040), (0.009, 0.050), (0.0, 0.054)], 16)
    spout = tube(np.linspace([0.0, 0.038, -0.012], SPOUT, 8), 0.008)
    angles = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 13)
    depth = JUG_BELLY + JUG_HANDLE_REACH - 0.030
    loop = np.column_stack(
        (np.zeros(13), -0.030 - depth * np.cos(angles) ** 0.7, 0.004 + 0.028 * np.sin(angles))
    )
    marks = [(0.0, 0.05, 0.04), (0.05, 0.0, -0.03), (-0.05, 0.0, -0.03), (0.0, 0.0, 0.054)]
    parts = [(body, STEEL), (knob, RED), (spout, STEEL), (tube(loop, 0.006), BLACK)]
    return build_model(NAME, parts, marks)


@dataclass(frozen=True)
class Taught:
    """A dataset's folder, its unlabelled recordings, who is in them, and where the object truly is,
    each of three arrays: translations (T, 3) and rotations (T, 4) of its own frame."""

    folder: Path
    recordings: tuple[Path, ...]
    people: tuple[Simulation, ...]
    truths: tuple[tuple[np.ndarray, np.ndarray], ...]


def make(rig: RunningRig, frames: int, seed: int) -> Taught:
    """Make the object by ``inhand object new``, and record people who use it."""
    model, mesh = kettle(), rig.folder / "kettle.stl"
    scaled = trimesh.Trimesh(1000.0 * model.vertices, model.faces, process=False)
    scaled.export(mesh)
    folder = rig.folder / "taught"
    options = ("--dataset", folder, "--mesh", mesh, "--unit", "mm", "--up", "z")
    finish(rig.inhand("object", "new", NAME, *options))
    offset = model.vertices.min(axis=0) - load_shape(folder / "objects" / NAME).vertices.min(axis=0)
    INTERACTIONS[INTERACTION] = Interaction(kettle, pour_cream.perform)
    camera = replace(KINECT, frame_rate=RATE_HZ)
    right_handed = (n for n in itertools.count() if sample_person(seed, n).handedness == "right")
    people = tuple(
        simulate(INTERACTION, number, seed, frames, camera)
        for number in itertools.islice(right_handed, 4)
    )
    takes = [Take(f"pour_p{one}", f"p{one}", person) for one, person in enumerate(people)]
    written = write_takes(
        rig.folder / "simulated", takes, {"seed": seed}, images=True, on_progress=lambda: None
    )
    (folder / "recordings").mkdir()
    recordings = []
    for entry in written.entries:
        path = folder / entry.file
        with RecordingWriter(path) as writer:
            for message in read_recording(written.path(entry)):
                if message.topic is not LABEL:
                    copy_message(writer, message)
        recordings.append(path)
    truths = tuple(
        (one.translations + rotations.rotate(one.rotations, offset), one.rotations)
        for one in people
    )
    return Taught(folder, tuple(recordings), people, truths)


def label_by_hand(taught: Taught, number: int, random: np.random.Generator) -> None:
    """Label a recording on the page, by keyframes that are as inexact as a person's."""
    recording, truth = taught.recordings[number], taught.truths[number]
    frames = np.linspace(0, len(truth[0]) - 1, MOST_KEYFRAMES).round().astype(int).tolist()
    with (
        labelling(recording, "--object", NAME) as (url, _),
        chromium() as browser,
        tab(browser, url) as page,
    ):
        person = LabellingPerson(page)
        for frame in frames:
            person.go(frame)
            aside, about = random.normal(size=(2, 3))
            place = truth[0][frame] + INACCURATE_M * aside / np.linalg.norm(aside)
            turn = rotations.from_vector(INACCURATE_RAD * about / np.linalg.norm(about))
            person.type_pose(place, rotations.multiply(turn, truth[1][frame]))
        person.fill("Interaction", INTERACTION)
        person.fill("Participant", f"p{number}")
        person.choose("Hand", taught.people[number].person.handedness)
        person.tick("Refined by the images")
        person.click("Write labels")
        person.wait_for("dataset.toml names it")


def label_truly(taught: Taught, folder: Path) -> list[Path]:
    """Write a dataset with the true labels of all; returns its recordings."""
    (folder / "recordings").mkdir(parents=True)
    (folder / "objects").symlink_to(taught.folder / "objects")
    written = []
    for number, (recording, truth) in enumerate(zip(taught.recordings, taught.truths, strict=True)):
        scene = load_scene(recording, "camera")
        path = folder / "recordings" / labelled_path(recording).name
        labels = Labels(*truth, np.zeros(len(truth[0]), bool))
        write_labels(scene, NAME, labels, path, {"object": NAME})
        entry = DatasetEntry(
            file=f"recordings/{path.name}",
            interaction=INTERACTION,
            participant=f"p{number}",
            object=NAME,
            handedness=taught.people[number].person.handedness,
            frame_rate=RATE_HZ,
        )
        add_entry(folder, entry)
        written.append(path)
    return written


def main() -> int:
    """Teach it, and say how near the taught model comes beside the one of true labels."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frames", type=int, default=330, help="of each recording")
    parser.add_argument("--seed", type=int, default=17)
    chosen = parser.parse_args()
    random = np.random.default_rng(chosen.seed)
    with tempfile.TemporaryDirectory() as folder:
        rig = RunningRig(Path(folder))
        try:
            taught = make(rig, chosen.frames, chosen.seed)
            print("made the kettle, and four people who pour", flush=True)
            truly = label_truly(taught, rig.folder / "truly")
            for number in range(3):
                began = time.monotonic()
                label_by_hand(taught, number, random)
                took_s = time.monotonic() - began
                print(
                    f"labelled p{number} by {MOST_KEYFRAMES} keyframes in {took_s:.0f} s",
                    flush=True,
                )
            by_hand, by_truth = rig.folder / "taught.model", rig.folder / "true.model"
            began = time.monotonic()
            finish(rig.inhand("train", taught.folder, "-o", by_hand))
            print(f"trained in {time.monotonic() - began:.0f} s", flush=True)
            finish(rig.inhand("train", rig.folder / "truly", "-o", by_truth, "--without", "p3"))
            errors = {
                name: replayed(rig, name, model, truly[3], 1.0).error_cm
                for name, model in (("by hand", by_hand), ("by truth", by_truth))
            }
        finally:
            rig.close()
    for name, error in errors.items():
        print(f"labels {name}: mean vertex error of the unseen person, live: {error:.2f} cm")
    print(f"{errors['by hand'] / errors['by truth']:.2f} times")
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""The real networks on drawn people: what no told disc can show is whether faces are found."""

from pathlib import Path

import numpy as np
import pytest
from drawn_heads import head_pixels
from fetched_weights import use_weights
from inhand_capture.estimation.networks import open_network
from inhand_capture.estimation.regions import Region
from inhand_capture.estimation.weights import FACES, WeightsError, models_folder
from inhand_capture.faces.discs import Disc
from inhand_capture.faces.face_detector import FaceDetector
from inhand_capture.faces.finder import FaceFinder, open_face_finder
from inhand_lab.world.messages import camera_info
from inhand_lab.world.simulation import Simulation, simulate
from inhand_schemas.joints import Joint
from numpy.typing import NDArray
from posed_person import INFO, ToldNetwork, seen, standing

pytestmark = pytest.mark.long
FRAME_NS = 33_333_333


@pytest.fixture
def finder(monkeypatch: pytest.MonkeyPatch) -> FaceFinder:
    use_weights(monkeypatch, "lite", "faces")
    return open_face_finder(open_network("lite"), trust_skeletons=False)


class ToldFaces:
    """Finds the faces that it is told of."""

    def __init__(self) -> None:
        self.discs: list[Disc] = []

    def find(self, _picture: NDArray[np.uint8], _view: object) -> list[Disc]:
        return self.discs


def test_the_head_of_a_body_that_is_lost_is_not_given_up_for_a_wrong_face_beside_it() -> None:
    network, faces = ToldNetwork([[seen(standing())]] * 10 + [[]]), ToldFaces()
    finder = FaceFinder(faces, network)  # type: ignore[arg-type]
    grey = np.full((480, 640, 3), 110, np.uint8)
    for number in range(10):
        before = finder.find(grey, number * FRAME_NS, (), INFO).mask(480, 640)
    head = np.argwhere(before).mean(axis=0)
    faces.discs = [Disc(float(head[1]) + 60.0, float(head[0]), 20.0)]
    after = finder.find(grey, 10 * FRAME_NS, (), INFO).mask(480, 640)
    assert before.any()
    assert not (before & ~after).any()
    assert after.sum() > before.sum()


def test_a_fault_of_what_looks_for_faces_is_not_swallowed() -> None:
    class Broken(ToldFaces):
        def find(self, _picture: NDArray[np.uint8], _view: object) -> list[Disc]:
            raise RuntimeError("something that nobody thought of")

    finder = FaceFinder(Broken(), ToldNetwork([[]]))  # type: ignore[arg-type]
    with pytest.raises(RuntimeError, match="nobody thought of"):
        finder.find(np.zeros((48, 64, 3), np.uint8), 0, (), INFO)


def test_with_time_both_ends_of_a_picture_are_looked_at_closer() -> None:
    class Looked(ToldFaces):
        def __init__(self) -> None:
            super().__init__()
            self.views: list[Region] = []

        def find(self, _picture: NDArray[np.uint8], view: object) -> list[Disc]:
            assert isinstance(view, Region)
            self.views.append(view)
            return []

    grey, sides = np.full((480, 640, 3), 110, np.uint8), []
    for both_ends in (False, True):
        faces = Looked()
        finder = FaceFinder(faces, ToldNetwork([[]]), both_ends=both_ends)  # type: ignore[arg-type]
        for _ in range(2):
            finder.look(grey, (), INFO)
        sides.append([round(view.x) for view in faces.views])
    live, recorded = sides
    assert live == [320, live[1], 320, 640 - live[1]]
    assert recorded == 2 * [320, live[1], 640 - live[1]]


@pytest.fixture(scope="module")
def drinking() -> Simulation:
    return simulate("drinkFromMug", 0, seed=3, frames=30)


def _shown(finder: FaceFinder, simulation: Simulation, colour: NDArray[np.uint8], frame: int):  # type: ignore[no-untyped-def]
    """What is hidden of a picture."""
    info = camera_info(simulation.intrinsics, 30.0)
    return finder.find(colour, frame * FRAME_NS, (), info).mask(*colour.shape[:2])


@pytest.mark.parametrize("interaction", ["drinkFromMug", "putOnGlasses", "sweepFloor"])
def test_no_pixel_of_a_drawn_head_is_shown_and_little_else_is_hidden(
    finder: FaceFinder, interaction: str
) -> None:
    simulation = simulate(interaction, 2, seed=11, frames=60)
    for frame in range(0, 60, 4):
        mask = _shown(finder, simulation, simulation.render(frame).colour, frame)
        assert not (head_pixels(simulation, frame) & ~mask).any()
        assert mask.mean() < 0.1


def test_two_people_s_heads_are_hidden(finder: FaceFinder, drinking: Simulation) -> None:
    hips = drinking.true_joints_in_camera[0, Joint.HIP_CENTER]
    middle = round(525.0 * hips[0] / hips[2] + 319.5)
    columns = slice(middle - 150, middle + 150)
    one, head = drinking.render(0).colour[:, columns], head_pixels(drinking, 0)[:, columns]
    two = np.ascontiguousarray(np.concatenate([one, one[:, ::-1]], axis=1))
    heads = np.concatenate([head, head[:, ::-1]], axis=1)
    for number in range(3):
        mask = _shown(finder, drinking, two, number)
        assert not (heads & ~mask).any()


def test_a_head_without_a_body_is_hidden(finder: FaceFinder, drinking: Simulation) -> None:
    colour, head = drinking.render(0).colour, head_pixels(drinking, 0)
    rows, columns = np.nonzero(head)
    low, left = rows.max() + 8, columns.mean()
    alone = np.full_like(colour, 110)
    window = (slice(0, low), slice(round(left) - 45, round(left) + 45))
    alone[window] = colour[window]
    for number in range(3):
        mask = _shown(finder, drinking, alone, number)
    assert (head & ~mask).sum() < 0.1 * head.sum()


@pytest.mark.parametrize("side", ["left", "right", "bottom"])
def test_a_head_that_the_picture_s_edge_cuts_is_hidden(
    finder: FaceFinder, drinking: Simulation, side: str
) -> None:
    rows, columns = np.nonzero(head_pixels(drinking, 0))
    row, column = round(rows.mean()) + 10, round(columns.mean())
    for frame in range(0, 16, 2):
        colour, head = drinking.render(frame).colour, head_pixels(drinking, frame)
        if side == "bottom":
            rolled = np.roll(colour, 480 - row, axis=0)
            rolled[: 480 - row] = 110
            colour, head = rolled, np.roll(head, 480 - row, axis=0)
            head[: 480 - row] = False
        else:
            kept = slice(column, None) if side == "left" else slice(0, column)
            colour, head = np.ascontiguousarray(colour[:, kept]), head[:, kept]
        mask = _shown(finder, drinking, colour, frame)
        assert head.any()
        assert frame < 4 or (head & ~mask).sum() <= 0.1 * head.sum()


def test_a_face_in_the_dark_is_hidden(finder: FaceFinder, drinking: Simulation) -> None:
    for frame in range(0, 16, 2):
        dark = (drinking.render(frame).colour // 12).astype(np.uint8)
        mask = _shown(finder, drinking, dark, frame)
        head = head_pixels(drinking, frame)
        assert frame < 4 or (head & ~mask).sum() <= 0.1 * head.sum()


def test_an_empty_room_is_shown(finder: FaceFinder, drinking: Simulation) -> None:
    room = np.asarray(drinking._scene.room.colour, np.uint8)
    for number in range(4):
        assert not _shown(finder, drinking, room, number).any()


def test_weights_of_another_network_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    folder: Path = use_weights(monkeypatch, "lite", "faces")
    with pytest.raises(WeightsError, match="holds the weights of another network"):
        FaceDetector(folder / "pose_landmark_lite.tflite")
    assert folder == models_folder()
    assert (folder / FACES.file).is_file()

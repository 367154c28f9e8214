"""What to hide of each picture, so that nobody's face is in it."""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import cv2
import numpy as np
from inhand_schemas.messages import CameraInfo, Person
from numpy.typing import NDArray

from inhand_capture.estimation.found_person import FoundPerson, PoseNetwork
from inhand_capture.estimation.networks import require_installed
from inhand_capture.estimation.regions import Region, whole_picture
from inhand_capture.estimation.weights import FACES, models_folder, require_weights
from inhand_capture.faces.discs import Disc, mask_of_discs
from inhand_capture.faces.face_detector import FaceDetector
from inhand_capture.faces.heads import head_of, head_of_skeleton
from inhand_capture.faces.holding import HeldHeads
from inhand_capture.faces.parameters import DEFAULT_FACES, FaceParameters


@dataclass(frozen=True)
class FacesFound:
    """Where faces are in a picture of that size (height, width), and whose bodies were found."""

    discs: Sequence[Disc]
    size: tuple[int, int]
    people: Sequence[FoundPerson]

    def mask(self, height: int, width: int) -> NDArray[np.bool_]:
        """The pixels (H, W) to hide of the picture, or of its depth, in that size."""
        return mask_of_discs(self.discs, self.size, (height, width))


class FaceFinder:
    """Finds faces in pictures that follow each other.

    Faces are looked for in a thread of its own while the network looks for people, since every
    frame waits for both.
    """

    def __init__(
        self,
        detector: FaceDetector,
        network: PoseNetwork,
        parameters: FaceParameters = DEFAULT_FACES,
        *,
        trust_skeletons: bool = True,
    ) -> None:
        """``trust_skeletons`` says whether those of the source tell where heads are, too."""
        self._detector = detector
        self._network = network
        self._parameters = parameters
        self._trust_skeletons = trust_skeletons
        self._held = HeldHeads(parameters)
        self._held_bodies = HeldHeads(parameters)
        self._pictures = 0
        self._thread = ThreadPoolExecutor(1, "faces")

    def find(
        self,
        colour: NDArray[np.uint8],
        time_ns: int,
        skeletons: Sequence[Person],
        info: CameraInfo,
    ) -> FacesFound:
        """Find faces in a picture (H, W, 3) RGB; ``skeletons`` of it, in space, have heads, too."""
        height, width = colour.shape[:2]
        lit = brightened(colour, self._parameters.least_brightness)
        looking = self._thread.submit(self._faces, lit)
        people = self._network.find(lit)
        heads = [head_of(one, self._parameters) for one in people]
        trusted = skeletons if self._trust_skeletons else ()
        known = [head_of_skeleton(one, info, self._parameters) for one in trusted]
        bodies = [
            [disc for disc in heads if disc is not None],
            [_scaled(disc, info, width) for disc in known if disc is not None],
        ]
        # Held by itself, so that the head of a body is not given up for a wrong face beside it.
        discs = self._held_bodies.see(bodies, time_ns)
        discs += self._held.see([*bodies, *looking.result()], time_ns)
        return FacesFound(tuple(dict.fromkeys(discs)), (height, width), people)

    def _faces(self, picture: NDArray[np.uint8]) -> list[list[Disc]]:
        """Look for faces, in one view after the other."""
        height, width = picture.shape[:2]
        views = self._views(width, height)
        self._pictures += 1
        return [self._detector.find(picture, view) for view in views]

    def _views(self, width: int, height: int) -> list[Region]:
        """Return where to look for faces: in all of a picture, and closer in one of its ends by
        turns, which reaches beyond the picture's edges."""
        shorter = float(min(width, height))
        beyond, beside = self._parameters.beyond * shorter, self._parameters.beside * shorter
        side = shorter + 2.0 * beside
        along = 0.5 * side - beyond
        if self._pictures % 2:
            along = max(width, height) - along
        x, y = (along, 0.5 * height) if width >= height else (0.5 * width, along)
        return [whole_picture(width, height), Region(x, y, side)]


def brightened(picture: NDArray[np.uint8], least: float) -> NDArray[np.uint8]:
    """Return a picture whose brightness, judged by one pixel of sixteen, is no less than that."""
    brightness = float(picture[::4, ::4].mean())
    if brightness >= least:
        return picture
    return np.asarray(cv2.convertScaleAbs(picture, alpha=least / max(brightness, 1.0)), np.uint8)


def _scaled(disc: Disc, info: CameraInfo, width: int) -> Disc:
    """Return a disc of the camera's pixels in those of a picture of another width."""
    scale = width / info.width
    return Disc(scale * (disc.x + 0.5) - 0.5, scale * (disc.y + 0.5) - 0.5, scale * disc.radius)


def require_face_detector() -> None:
    """Check, without loading it, that faces can be found; raises WeightsError, or SettingsError
    where LiteRT is not installed."""
    require_installed("ai_edge_litert", "pose", "mask_faces needs")
    require_weights(FACES, models_folder())


def open_face_finder(network: PoseNetwork, *, trust_skeletons: bool) -> FaceFinder:
    """Load what finds faces, beside a network that finds bodies; raises what
    ``require_face_detector`` does."""
    require_face_detector()
    detector = FaceDetector(models_folder() / FACES.file)
    return FaceFinder(detector, network, trust_skeletons=trust_skeletons)

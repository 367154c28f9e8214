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


@dataclass(frozen=True, slots=True)
class HeadsSeen:
    """What was seen in one picture, by itself: the heads of bodies and faces, a sequence for each
    who looked, as discs of the picture; and the bodies that the network found."""

    of_bodies: Sequence[Sequence[Disc]]
    faces: Sequence[Sequence[Disc]]
    people: Sequence[FoundPerson]


class HeldSightings:
    """Says what to hide of pictures that follow each other, by what was seen in each."""

    def __init__(self, parameters: FaceParameters = DEFAULT_FACES) -> None:
        self._heads = HeldHeads(parameters)
        self._of_bodies = HeldHeads(parameters)

    def see(self, seen: HeadsSeen, time_ns: int) -> tuple[Disc, ...]:
        """Return the discs to hide of a picture: of what is seen in it, or was shortly before."""
        # Held by itself, so that the head of a body is not given up for a wrong face beside it.
        discs = self._of_bodies.see(seen.of_bodies, time_ns)
        discs += self._heads.see([*seen.of_bodies, *seen.faces], time_ns)
        return tuple(dict.fromkeys(discs))


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
        both_ends: bool = False,
    ) -> None:
        """``trust_skeletons`` says whether those of the source tell where heads are, too, and
        ``both_ends`` whether there is time to look closer in both ends of each picture."""
        self._detector = detector
        self._network = network
        self._parameters = parameters
        self._trust_skeletons = trust_skeletons
        self._both_ends = both_ends
        self._held = HeldSightings(parameters)
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
        seen = self.look(colour, skeletons, info)
        return FacesFound(self._held.see(seen, time_ns), colour.shape[:2], seen.people)

    def look(
        self, colour: NDArray[np.uint8], skeletons: Sequence[Person], info: CameraInfo
    ) -> HeadsSeen:
        """Look at a picture as ``find`` does, and say what is in it, whatever was before."""
        lit = brightened(colour, self._parameters.least_brightness)
        looking = self._thread.submit(self._faces, lit)
        people = self._network.find(lit)
        heads = [head_of(one, self._parameters) for one in people]
        trusted = skeletons if self._trust_skeletons else ()
        known = [head_of_skeleton(one, info, self._parameters) for one in trusted]
        scale = colour.shape[1] / info.width
        of_bodies = [
            [disc for disc in heads if disc is not None],
            [disc.scaled(scale) for disc in known if disc is not None],
        ]
        return HeadsSeen(of_bodies, looking.result(), people)

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
        first = 0.5 * side - beyond
        ends = [first, max(width, height) - first]
        if not self._both_ends:
            ends = [ends[self._pictures % 2]]
        middles = [
            (along, 0.5 * height) if width >= height else (0.5 * width, along) for along in ends
        ]
        return [whole_picture(width, height), *(Region(x, y, side) for x, y in middles)]


def brightened(picture: NDArray[np.uint8], least: float) -> NDArray[np.uint8]:
    """Return a picture whose brightness, judged by one pixel of sixteen, is no less than that."""
    brightness = float(picture[::4, ::4].mean())
    if brightness >= least:
        return picture
    return np.asarray(cv2.convertScaleAbs(picture, alpha=least / max(brightness, 1.0)), np.uint8)


def require_face_detector() -> None:
    """Check, without loading it, that faces can be found; raises WeightsError, or SettingsError
    where LiteRT is not installed."""
    require_installed("ai_edge_litert", "pose", "mask_faces needs")
    require_weights(FACES, models_folder())


def open_face_finder(
    network: PoseNetwork, *, trust_skeletons: bool, both_ends: bool = False
) -> FaceFinder:
    """Load what finds faces, beside a network that finds bodies; raises what
    ``require_face_detector`` does."""
    require_face_detector()
    detector = FaceDetector(models_folder() / FACES.file)
    return FaceFinder(detector, network, trust_skeletons=trust_skeletons, both_ends=both_ends)

"""Networks of COCO's 17 key points in an ONNX file, which find all people of a picture at once.

The layout is that of YOLO's pose networks: pictures (1, 3, S, S) RGB from 0 to 1, and one output
(1, 56, N): for each of N candidates a box's middle and size, its score, and x, y and score of each
key point, all in the network's pixels.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from inhand_runtime.errors import SettingsError
from inhand_runtime.extras import missing_extra
from inhand_schemas.joints import Joint
from numpy.typing import NDArray

from inhand_capture.estimation.boxes import overlap
from inhand_capture.estimation.found_person import Floats, FoundPerson
from inhand_capture.estimation.parameters import DEFAULT_COCO, CocoParameters
from inhand_capture.estimation.regions import Region, crop, whole_picture
from inhand_capture.estimation.weights import WeightsError

POINTS = 17
ROWS = 5 + 3 * POINTS
EARS = (3, 4)
PLACES: dict[Joint, tuple[int, ...]] = {
    Joint.HEAD: EARS,
    Joint.SHOULDER_LEFT: (5,),
    Joint.SHOULDER_RIGHT: (6,),
    Joint.ELBOW_LEFT: (7,),
    Joint.ELBOW_RIGHT: (8,),
    Joint.WRIST_LEFT: (9,),
    Joint.WRIST_RIGHT: (10,),
    Joint.HIP_LEFT: (11,),
    Joint.HIP_RIGHT: (12,),
    Joint.KNEE_LEFT: (13,),
    Joint.KNEE_RIGHT: (14,),
    Joint.ANKLE_LEFT: (15,),
    Joint.ANKLE_RIGHT: (16,),
}
"""Which key points each joint is the middle of; hands and feet are unknown to COCO."""


class CocoNetwork:
    """Finds people by an ONNX file, each picture anew."""

    def __init__(self, path: Path, parameters: CocoParameters = DEFAULT_COCO) -> None:
        """Load a network; raises WeightsError for a file that is no such network, and
        SettingsError where ONNX Runtime is not installed."""
        try:
            import onnxruntime
        except ModuleNotFoundError as error:
            raise SettingsError(f"a network of ONNX {missing_extra(error) or error}") from None
        onnxruntime.disable_telemetry_events()
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = 1
        try:
            self._session: Any = onnxruntime.InferenceSession(
                str(path), options, providers=["CPUExecutionProvider"]
            )
        except Exception as error:
            # ONNX Runtime raises classes of its own, which it does not publish.
            if type(error).__module__.startswith("onnxruntime"):
                raise WeightsError(f"{path} is no network of ONNX: {_line(error)}") from None
            raise
        self._name, self._side = _input_of(self._session, path)
        self._parameters = parameters

    def find(self, colour: NDArray[np.uint8]) -> Sequence[FoundPerson]:
        """Find the people in a picture (H, W, 3) RGB, the surest first."""
        height, width = colour.shape[:2]
        view = whole_picture(width, height)
        cut = crop(colour, view, self._side, beside="grey")
        taken = np.ascontiguousarray(cut.transpose(2, 0, 1)[None], np.float32) / np.float32(255.0)
        (candidates,) = self._session.run(None, {self._name: taken})
        return self._people(candidates[0].T.astype(float), view)

    def _people(self, candidates: Floats, view: Region) -> list[FoundPerson]:
        """Return the people of candidates (N, 56), of which several may be one person."""
        parameters = self._parameters
        good = candidates[candidates[:, 4] >= parameters.person_score]
        good = good[np.argsort(-good[:, 4], kind="stable")]
        chosen: list[Floats] = []
        for one in good:
            if len(chosen) == parameters.most_people:
                break
            if all(overlap(one[:4], other[:4]) < parameters.same_person for other in chosen):
                chosen.append(one)
        return [self._person(one[5:].reshape(POINTS, 3), view) for one in chosen]

    def _person(self, points: Floats, view: Region) -> FoundPerson:
        places, scores = view.to_picture(points[:, :2], self._side), points[:, 2]
        pixels, visibilities = np.full((len(Joint), 2), np.nan), np.zeros(len(Joint))
        for joint, parts in PLACES.items():
            pixels[joint] = places[list(parts)].mean(axis=0)
            visibilities[joint] = np.clip(scores[list(parts)].max(), 0.0, 1.0)
        return FoundPerson(pixels, np.full(len(Joint), np.nan), visibilities)


def _input_of(session: Any, path: Path) -> tuple[str, int]:
    """Return the name and the side of a network's input; raises WeightsError for another one."""
    taken, given = session.get_inputs(), session.get_outputs()
    if len(taken) == len(given) == 1:
        shape, rows = taken[0].shape, given[0].shape
        square = len(shape) == 4 and shape[1] == 3 and shape[2] == shape[3]
        if square and isinstance(shape[2], int) and len(rows) == 3 and rows[1] == ROWS:
            return taken[0].name, int(shape[2])
    raise WeightsError(
        f"{path} is another network: it should take pictures (1, 3, S, S), and give "
        f"(1, {ROWS}, N), as YOLO's pose networks of COCO's {POINTS} key points do"
    )


def _line(error: Exception) -> str:
    return " ".join(str(error).split())[:200]

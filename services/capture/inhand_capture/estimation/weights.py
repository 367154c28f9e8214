"""The weight files of the networks that are known by name: where they are, and whether they are
the right ones."""

import hashlib
from dataclasses import dataclass
from pathlib import Path

from inhand_runtime.data_folder import data_folder
from inhand_runtime.errors import InhandError


@dataclass(frozen=True)
class PinnedPackage:
    """One version of a package of a registry, by the SHA-256 of its archive.

    ``client`` is the program that gets it: pip or npm.
    """

    client: str
    name: str
    version: str
    sha256: str


@dataclass(frozen=True)
class WeightFile:
    """A file of weights, and the member of a package that it is."""

    file: str
    sha256: str
    package: PinnedPackage
    member: str


WHEEL = PinnedPackage(
    client="pip",
    name="mediapipe",
    version="0.10.21",
    sha256="05dc4a9e593655a79558d05d6227d31018c2537a4bd3362b51e230cf22aecfe3",
)
"""The last wheel that holds weights, for one platform: it is only unpacked, and never installed."""
TARBALL = PinnedPackage(
    client="npm",
    name="@mediapipe/pose",
    version="0.5.1675469404",
    sha256="8bb349a7b3a3ba699df23be804ddd3b3eab810b50b15406894be257859388a84",
)

DETECTOR = WeightFile(
    "pose_detection.tflite",
    "9ba9dd3d42efaaba86b4ff0122b06f29c4122e756b329d89dca1e297fd8f866c",
    WHEEL,
    "mediapipe/modules/pose_detection/pose_detection.tflite",
)
FACES = WeightFile(
    "face_detection_full_range_sparse.tflite",
    "2c3728e6da56f21e21a320433396fb06d40d9088f2247c05e5635a688d45dfe1",
    WHEEL,
    "mediapipe/modules/face_detection/face_detection_full_range_sparse.tflite",
)
LANDMARKS = {
    "lite": WeightFile(
        "pose_landmark_lite.tflite",
        "f17bfbecadb61c3be1baa8b8d851cc6619c870a87167b32848ad20db306b9d61",
        TARBALL,
        "package/pose_landmark_lite.tflite",
    ),
    "full": WeightFile(
        "pose_landmark_full.tflite",
        "e9a5c5cb17f736fafd4c2ec1da3b3d331d6edbe8a0d32395855aeb2cdfd64b9f",
        WHEEL,
        "mediapipe/modules/pose_landmark/pose_landmark_full.tflite",
    ),
    "heavy": WeightFile(
        "pose_landmark_heavy.tflite",
        "59e42d71bcd44cbdbabc419f0ff76686595fd265419566bd4009ef703ea8e1fe",
        TARBALL,
        "package/pose_landmark_heavy.tflite",
    ),
}
"""The landmark networks by name, from the fastest to the most exact."""
KNOWN = (DETECTOR, FACES, *LANDMARKS.values())
FACES_NAME = "faces"
"""By this name the network that finds faces is fetched."""


class WeightsError(InhandError):
    """Weights that are not there, or not the right ones."""


def models_folder() -> Path:
    """Return the folder of the weight files, which need not exist."""
    return data_folder() / "models"


def files_of(network: str) -> tuple[WeightFile, ...]:
    """Name the files of a network: the detector's and the landmarks', or the one for faces."""
    return (FACES,) if network == FACES_NAME else (DETECTOR, LANDMARKS[network])


def require_weights(weights: WeightFile, folder: Path) -> Path:
    """Find a weight file and check that it is the right one; raises WeightsError."""
    path = folder / weights.file
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        raise WeightsError(
            f"there are no weights at {path}: fetch them with `inhand models fetch{_wish(weights)}`"
        ) from None
    except OSError as error:
        raise WeightsError(f"cannot read the weights {path}: {error.strerror}") from None
    if (fault := fault_in(weights, data)) is not None:
        raise WeightsError(
            f"{path} {fault}: fetch it again with `inhand models fetch{_wish(weights)}`"
        )
    return path


def fault_in(weights: WeightFile, data: bytes) -> str | None:
    """Say what is wrong with the bytes of a weight file; None where they are right."""
    digest = hashlib.sha256(data).hexdigest()
    if digest == weights.sha256:
        return None
    for other in KNOWN:
        if digest == other.sha256:
            return f"holds the weights of another network, {other.file}"
    return f"is damaged or another file (SHA-256 {digest[:12]}…, not {weights.sha256[:12]}…)"


def _wish(weights: WeightFile) -> str:
    """The argument of the verb that fetches a file, where it is not fetched without one."""
    names = [name for name in (*LANDMARKS, FACES_NAME) if weights in files_of(name)]
    return "" if DEFAULT_NETWORK in names else f" {names[0]}"


DEFAULT_NETWORK = "full"
"""The usual landmark network: ``lite`` takes four milliseconds less a picture, and has arms and
legs wrong more often (`inhand bench skeletons` measures the usual one)."""

"""Opens a pose network by its name, or by its file."""

from importlib.util import find_spec
from pathlib import Path

from inhand_runtime.errors import SettingsError
from inhand_schemas import conventions

from inhand_capture.estimation.blazepose import BlazePose
from inhand_capture.estimation.coco import CocoNetwork
from inhand_capture.estimation.found_person import PoseNetwork
from inhand_capture.estimation.weights import (
    LANDMARKS,
    WeightsError,
    files_of,
    models_folder,
    require_weights,
)

SUFFIX = ".onnx"
NEED = "skeletons from images need"
"""Beginning of what is said where the extra is not installed."""


def require_network(network: str | Path) -> None:
    """Check, without loading it, that a network can be opened.

    ``network`` is a name in ``LANDMARKS``, or an ONNX file. Raises WeightsError where its weights
    are not there or not right, and SettingsError where what runs it is not installed, or where it
    is neither.
    """
    if isinstance(network, Path):
        _require_file(network)
        require_installed("onnxruntime", "onnx", NEED)
        return
    require_installed("ai_edge_litert", "pose", NEED)
    for weights in files_of(network):
        require_weights(weights, models_folder())


def open_network(network: str | Path) -> PoseNetwork:
    """Load a network; raises what ``require_network`` does, and WeightsError for a file that is
    another network."""
    require_network(network)
    if isinstance(network, Path):
        return CocoNetwork(network)
    return BlazePose(network, models_folder())


def convention_of(network: str | Path) -> str:
    """Name the convention of the skeletons that a network's joints become."""
    return conventions.COCO if isinstance(network, Path) else conventions.BLAZEPOSE


def _require_file(path: Path) -> None:
    if path.suffix != SUFFIX:
        raise SettingsError(
            f"{str(path)!r} is no network: name one of {', '.join(LANDMARKS)}, or a file {SUFFIX}"
        )
    if not path.is_file():
        raise WeightsError(f"there is no network at {path}: check the path")


def require_installed(module: str, extra: str, need: str) -> None:
    """Raise SettingsError, which begins with what needs the extra, where it is not installed."""
    if find_spec(module) is None:
        raise SettingsError(f'{need} the extra {extra!r}: pip install "inhand[{extra}]"')

"""Opens a pose network by its name in the settings."""

from importlib.util import find_spec

from inhand_runtime.errors import SettingsError

from inhand_capture.estimation.blazepose import BlazePose
from inhand_capture.estimation.found_person import PoseNetwork
from inhand_capture.estimation.weights import files_of, models_folder, require_weights


def require_network(name: str) -> None:
    """Check, without loading it, that a network can be opened.

    Raises WeightsError where its weights are not there or not right, and SettingsError where what
    runs it is not installed.
    """
    if find_spec("ai_edge_litert") is None:
        raise SettingsError(
            "skeletons from images need the extra 'pose': pip install \"inhand[pose]\""
        )
    for weights in files_of(name):
        require_weights(weights, models_folder())


def open_network(name: str) -> PoseNetwork:
    """Load a network; raises what ``require_network`` does."""
    require_network(name)
    return BlazePose(name, models_folder())

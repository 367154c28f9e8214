"""Measures what a frame of skeletons from images costs on one core, by its stages."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from inhand_capture.estimation.estimator import SkeletonEstimator
from inhand_capture.estimation.found_person import FoundPerson, PoseNetwork
from inhand_runtime.pixels import decode_colour, encode_colour
from numpy.typing import NDArray

from inhand_lab.benchmarks.estimated_skeletons import simulated_frames
from inhand_lab.benchmarks.parameters import DEFAULT_SKELETON_CHECK, SkeletonCheckParameters
from inhand_lab.sensing.cameras import CAMERAS, Camera
from inhand_lab.world.messages import camera_info

INTERACTION = "drinkFromMug"


@dataclass(frozen=True)
class EstimationCost:
    """Processor time of a frame with one person, milliseconds (medians).

    ``decoding_ms`` is that of a JPEG, for sources whose pictures come encoded.
    """

    width: int
    height: int
    network_ms: float
    lifting_ms: float
    whole_ms: float
    decoding_ms: float


class Timed:
    """A network whose time in the last picture can be asked for."""

    def __init__(self, network: PoseNetwork) -> None:
        self._network = network
        self.seconds = 0.0

    def find(self, colour: NDArray[np.uint8]) -> Sequence[FoundPerson]:
        """Find the people in a picture, and note how long that took."""
        began = time.process_time()
        people = self._network.find(colour)
        self.seconds = time.process_time() - began
        return people


def measure_estimation(
    new_network: Callable[[], PoseNetwork],
    parameters: SkeletonCheckParameters = DEFAULT_SKELETON_CHECK,
) -> list[EstimationCost]:
    """Measure a frame at each camera's size."""
    return [_measured(camera, Timed(new_network()), parameters) for camera in CAMERAS.values()]


def _measured(
    camera: Camera, network: Timed, parameters: SkeletonCheckParameters
) -> EstimationCost:
    estimator = SkeletonEstimator(network, camera_info(camera.intrinsics, camera.frame_rate))
    shown = replace(parameters, frames=parameters.untimed_frames + parameters.timed_frames)
    whole, finding, decoding = [], [], []
    for number, (colour, depth, _) in enumerate(simulated_frames(INTERACTION, 0, camera, shown), 1):
        began = time.process_time()
        estimator.estimate(colour, depth, round(number * 1e9 / camera.frame_rate))
        whole.append(time.process_time() - began)
        finding.append(network.seconds)
        encoded = encode_colour(colour)
        began = time.process_time()
        decode_colour(encoded)
        decoding.append(time.process_time() - began)
    spent = 1e3 * np.array([finding, whole, decoding])[:, parameters.untimed_frames :]
    network_ms, whole_ms, decoding_ms = (float(value) for value in np.median(spent, axis=1))
    lifting_ms = float(np.median(spent[1] - spent[0]))
    return EstimationCost(
        camera.intrinsics.width,
        camera.intrinsics.height,
        network_ms,
        lifting_ms,
        whole_ms,
        decoding_ms,
    )

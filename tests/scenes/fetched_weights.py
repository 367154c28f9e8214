"""The real weights of pose networks: those that are on this machine, or fetched for the run."""

import fcntl
import os
import tempfile
from pathlib import Path

import pytest
from inhand_capture.estimation.fetching import fetch_network
from inhand_capture.estimation.weights import (
    WeightsError,
    files_of,
    models_folder,
    require_weights,
)
from inhand_runtime.data_folder import DATA_VARIABLE


def use_weights(monkeypatch: pytest.MonkeyPatch, *networks: str) -> Path:
    """Let this test and its processes find the weights of networks; return their folder.

    Skips the test where they are neither here nor to be had.
    """
    if not all(_are_in(network, models_folder()) for network in networks):
        data = Path(tempfile.gettempdir()) / f"inhand-test-data-{os.getuid()}"
        data.mkdir(exist_ok=True)
        with (data / "lock").open("w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            try:
                for network in networks:
                    fetch_network(network, data / "models", print)
            except WeightsError as error:
                pytest.skip(str(error))
        monkeypatch.setenv(DATA_VARIABLE, str(data))
    return models_folder()


def _are_in(network: str, folder: Path) -> bool:
    try:
        for weights in files_of(network):
            require_weights(weights, folder)
    except WeightsError:
        return False
    return True

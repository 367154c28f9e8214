"""Networks of LiteRT: a file of weights, called as a function of arrays."""

import os
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from inhand_runtime.errors import SettingsError
from inhand_runtime.extras import missing_extra
from numpy.typing import NDArray

from inhand_capture.estimation.weights import WeightsError

STDERR = 2
"""File descriptor of standard error."""

Tensors = Mapping[str, NDArray[np.float32]]


class LiteRtNetwork:
    """One network on one thread; outputs are known by their names, whose order differs."""

    def __init__(self, path: Path, side: int, outputs: Mapping[str, int]) -> None:
        """Load a network of pictures (side, side, 3) with outputs of these numbers of values.

        Raises WeightsError for a file that is no such network, and SettingsError where LiteRT is
        not installed.
        """
        try:
            from ai_edge_litert.interpreter import Interpreter
        except ModuleNotFoundError as error:
            raise SettingsError(f"a network of LiteRT {missing_extra(error) or error}") from None
        try:
            with _without_chatter():
                self._interpreter: Any = Interpreter(str(path), num_threads=1)
                self._interpreter.allocate_tensors()
        except (ValueError, RuntimeError) as error:
            raise WeightsError(f"{path} is no network of LiteRT: {error}") from None
        self._outputs = {
            one["name"]: int(one["index"]) for one in self._interpreter.get_output_details()
        }
        (taken,) = self._interpreter.get_input_details()
        self._input = int(taken["index"])
        sizes = {
            one["name"]: int(np.prod(one["shape"]))
            for one in self._interpreter.get_output_details()
        }
        wrong = [name for name, size in outputs.items() if sizes.get(name) != size]
        if wrong or tuple(taken["shape"]) != (1, side, side, 3):
            raise WeightsError(f"{path} holds the weights of another network")

    def __call__(self, picture: NDArray[np.float32]) -> Tensors:
        """Return the outputs, each without its first axis, for a picture (side, side, 3)."""
        self._interpreter.set_tensor(self._input, picture[None])
        self._interpreter.invoke()
        return {
            name: self._interpreter.get_tensor(index)[0] for name, index in self._outputs.items()
        }


CHATTER = b"INFO: "
"""Beginning of the lines that LiteRT writes to standard error whatever it is told."""


@contextmanager
def _without_chatter() -> Iterator[None]:
    """Keep what LiteRT says of itself out of standard error, which may be a log of JSON lines; all
    else that is written there meanwhile is written after the block."""
    sys.stderr.flush()
    with tempfile.TemporaryFile() as meanwhile:
        usual = os.dup(STDERR)
        os.dup2(meanwhile.fileno(), STDERR)
        try:
            yield
        finally:
            sys.stderr.flush()
            os.dup2(usual, STDERR)
            os.close(usual)
            meanwhile.seek(0)
            for line in meanwhile:
                if not line.startswith(CHATTER):
                    os.write(STDERR, line)

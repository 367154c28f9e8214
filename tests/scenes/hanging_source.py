"""A simulated camera that hangs on its side, or upside down.

``quarters`` says how often its pictures are turned clockwise by a quarter; all other options are
the simulator's.
"""

from collections.abc import Mapping
from typing import Annotated, Any

from inhand_capture.view.viewed_source import ViewedSource
from inhand_lab.world.simulator import SimulatorOptions, SimulatorSource
from pydantic import Field


class HangingOptions(SimulatorOptions):
    """The simulator's, and how the camera hangs."""

    quarters: Annotated[int, Field(ge=1, le=3)]


class HangingSource(ViewedSource):
    """See the module."""

    options_model = HangingOptions

    def __init__(self, options: Mapping[str, Any]) -> None:
        rest = {name: value for name, value in options.items() if name != "quarters"}
        super().__init__(SimulatorSource(rest), options["quarters"], ())

"""The source ``pluggable``: a simulated camera that somebody can unplug."""

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from inhand_runtime.source import Captured, SourceAbsentError, SourceLostError
from inhand_schemas.messages import CameraInfo

from inhand_lab.world.simulator import SimulatorOptions, SimulatorSource


class PluggableOptions(SimulatorOptions):
    """``[capture.NAME.options]``: those of a simulator, and the file that is there while the camera
    is."""

    plug: Path


class PluggableSource:
    """A simulated camera whose driver says what a real one's does when it is unplugged."""

    options_model = PluggableOptions

    def __init__(self, options: Mapping[str, Any]) -> None:
        others = {name: value for name, value in options.items() if name != "plug"}
        self._plug = Path(options["plug"])
        if not self._plug.exists():
            raise SourceAbsentError("no camera is attached")
        self._camera = SimulatorSource(others)

    @property
    def info(self) -> CameraInfo:
        """How the simulated camera sees."""
        return self._camera.info

    def captures(self, wanted: Callable[[], bool]) -> Iterator[Captured | None]:
        """Frames until it is unplugged, which raises SourceLostError."""
        for captured in self._camera.captures(wanted):
            if not self._plug.exists():
                raise SourceLostError("the camera was unplugged")
            yield captured

    def close(self) -> None:
        """End ``captures``."""
        self._camera.close()

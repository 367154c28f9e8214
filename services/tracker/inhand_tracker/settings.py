"""What a settings file says of a tracker."""

from pathlib import Path

from inhand_runtime.settings import FilePath, Section
from inhand_schemas.fields import Name
from pydantic import Field, PositiveInt

from inhand_tracker.geometry.image import MOST_VIEWS
from inhand_tracker.methods.registry import DEFAULT_METHOD, AnyTerm, MethodName


class TrackerSettings(Section):
    """``[tracker.NAME]``: objects of one person or several, seen by one camera, or by the
    ``cameras`` of a rig together, of which the first one that sends is the poses'. Where they are,
    and how their clocks differ, says the rig's ``calibration``; without it, they themselves say
    where they are.

    With a ``recogniser`` each person uses at most one of the models' objects, whichever is
    recognised; without one every object is in use. ``every_frame`` is for work where each frame
    matters more than being on time: none is skipped, and each takes the tracker's whole effort.
    """

    model: FilePath | None = None
    models: tuple[FilePath, ...] = ()
    camera: Name = "camera"
    cameras: tuple[Name, ...] = Field(default=(), max_length=MOST_VIEWS)
    calibration: FilePath | None = None
    method: MethodName = DEFAULT_METHOD
    left_handed: bool = False
    likelihood: tuple[AnyTerm, ...] | None = None
    particles: PositiveInt | None = None
    recogniser: FilePath | None = None
    people: PositiveInt = 1
    every_frame: bool = False
    seed: int = Field(default=0, ge=0)

    @property
    def camera_names(self) -> tuple[str, ...]:
        """The names of all cameras, however the settings name them."""
        return self.cameras or (self.camera,)

    @property
    def model_files(self) -> tuple[Path, ...]:
        """The files of the models, however the settings name them."""
        return self.models if self.model is None else (self.model,)

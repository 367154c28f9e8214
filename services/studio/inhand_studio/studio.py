"""What all pages of a studio have at hand."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from inhand_runtime.daemon import Daemon
from inhand_runtime.errors import InhandError

from inhand_studio.rig import Rig
from inhand_studio.shapes import Shapes
from inhand_studio.training_page.training import Trainings


@dataclass(frozen=True)
class Studio:
    """The ``dataset`` that pages show and write, and the ``daemon`` whose rig they look at: None
    where a recording is looked at without a rig, as is ``rig``, what is heard of it. ``recording``
    is the one to begin with, and ``object_name`` the object, if any. ``models`` are the rig's, as
    far as its settings name them, in the file ``config``."""

    dataset: Path
    daemon: Daemon | None = None
    recording: Path | None = None
    object_name: str | None = None
    rig: Rig | None = None
    models: tuple[Path, ...] = ()
    config: Path | None = None

    @cached_property
    def trainings(self) -> Trainings:
        """The training that runs, or ran last, for whichever tab looks."""
        return Trainings()

    def require_rig(self) -> Rig:
        """Return what is heard of the rig; raises InhandError where there is none."""
        if self.rig is None:
            raise InhandError(
                "this studio looks at no rig: start `inhand studio` with the rig's --config"
            )
        return self.rig

    @cached_property
    def shapes(self) -> Shapes:
        """The shapes of objects that are known here."""
        return Shapes(self.dataset, self.models)

"""What a tracker needs to know of one object in one interaction."""

from dataclasses import dataclass

from inhand_runtime.errors import InhandError

from inhand_tracker.mapping.mapping import Mapping
from inhand_tracker.model.taught import TaughtRecordings
from inhand_tracker.prior.prior import Prior
from inhand_tracker.shape.shape import ObjectShape
from inhand_tracker.shape.viewpoints import Viewpoints
from inhand_tracker.sight.appearance import Appearance


class ModelError(InhandError):
    """A model, or another learned file, that cannot be used; the message says the mend."""


@dataclass(frozen=True)
class Model:
    """What was learned of one object in one interaction.

    Models of older releases lack an ``appearance`` or a ``prior``; models of objects without
    recorded images lack an ``appearance`` too. ``taught`` are the recordings that it was learned
    from, by which it can be adapted; models of older releases lack them.
    """

    interaction: str
    shape: ObjectShape
    mapping: Mapping
    viewpoints: Viewpoints
    appearance: Appearance | None = None
    prior: Prior | None = None
    taught: TaughtRecordings | None = None

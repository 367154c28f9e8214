"""What an image says for an object's being there at all, part by part."""

from typing import NamedTuple


class Support(NamedTuple):
    """How many times likelier (log) an image is with the object, at the likeliest pose and in its
    colours of training, than without: the parts of which that is the sum."""

    edges: float
    region: float
    interior: float
    depth: float
    recoloured: float = 0.0
    """How much more of the object's interior speak the colours that were learned since."""

    @property
    def parts(self) -> tuple[float, ...]:
        return self[:PARTS]

    @property
    def log_likelihood(self) -> float:
        return sum(self.parts)


PARTS = 4
INTERIOR = Support._fields.index("interior")

"""How much an image supports that an object is there at all, part by part."""

from typing import NamedTuple


class Support(NamedTuple):
    """The log-likelihood ratio of an image with an object, at its likeliest pose and in its colours
    of training, against the image without it, by the parts that it is the sum of."""

    edges: float
    region: float
    interior: float
    depth: float
    recoloured: float = 0.0
    """Log-likelihood ratio of the interior in the colours learned since training, beyond that in
    the colours of training."""

    @property
    def parts(self) -> tuple[float, ...]:
        """The ratios of edges, region, interior and depth."""
        return self[:PARTS]

    @property
    def log_likelihood(self) -> float:
        """The log-likelihood ratio of the whole image."""
        return sum(self.parts)


PARTS = 4
"""Number of fields whose sum is the log-likelihood ratio."""
INTERIOR = Support._fields.index("interior")

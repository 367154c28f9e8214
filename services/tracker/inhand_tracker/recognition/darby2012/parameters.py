"""Every number of the published cascade, as Darby et al. 2012 give them."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Darby2012Parameters:
    """Decides how particles over actions are drawn (sections 4 and 5)."""

    stays: float = 0.997
    """Probability A_ii that a particle keeps its action in the next frame (section 5)."""
    neighbour_sigma: float = 7.0
    """Standard deviation of the rank, among nearest neighbours, of the training pose that a
    particle goes on to."""
    top_mass: float = 0.5
    """Share of the memberships that the likeliest actions hold, which importance particles are
    drawn from."""
    particle_shares: tuple[float, float, float] = (0.5, 0.4, 0.1)
    """Shares, on average, of action, importance and initialiser particles."""


DEFAULT_DARBY2012 = Darby2012Parameters()

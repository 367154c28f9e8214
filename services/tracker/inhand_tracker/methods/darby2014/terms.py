"""What of an image the likelihood of the published methods can weigh."""

from typing import Literal, get_args

Term = Literal["edges", "depth"]

TERMS: tuple[Term, ...] = get_args(Term)
DEFAULT_TERMS: tuple[Term, ...] = ("edges",)
"""The terms that Darby et al. 2014 publish figures for."""

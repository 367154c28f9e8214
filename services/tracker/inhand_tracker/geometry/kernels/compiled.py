"""Compiling functions of small arrays so that they take any number of them, as NumPy's own do."""

import re
from collections.abc import Callable, Collection
from typing import Any

from numba import guvectorize


def compiled(
    layout: str, singles: Collection[int] = ()
) -> Callable[[Callable[..., None]], Callable[..., Any]]:
    """Compile a function of double arrays by its ``layout``, NumPy's signature of generalised
    functions; the arguments numbered by ``singles`` are of single precision.

    The function fills its last arguments, which the layout names behind the arrow, and its callers
    get them as results.
    """
    inputs, outputs = layout.split("->")
    types = []
    for number, dimensions in enumerate(re.findall(r"\(([^)]*)\)", inputs + outputs)):
        scalar = not dimensions and number < inputs.count("(")
        axes = ",".join(":" * max(1, len(dimensions.split(","))))
        precision = "float32" if number in singles else "float64"
        types.append(precision if scalar else f"{precision}[{axes}]")
    decorate: Callable[[Callable[..., None]], Callable[..., Any]] = guvectorize(  # type: ignore[no-untyped-call]
        [f"void({', '.join(types)})"], layout, nopython=True, cache=True
    )
    return decorate

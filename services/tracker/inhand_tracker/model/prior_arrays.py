"""A prior as arrays by name, for a model's file."""

from dataclasses import fields
from itertools import count, takewhile

import numpy as np

from inhand_tracker.model.archive import Arrays
from inhand_tracker.prior.hold import Hold
from inhand_tracker.prior.kernel_ridge import KernelRidge
from inhand_tracker.prior.prior import Prior


def prior_to_arrays(prior: Prior) -> Arrays:
    """Take a prior apart: ``regressionv.…`` are the arrays of regression v, ``hold.…`` a hold's."""
    names = [field.name for field in fields(Prior) if field.name not in ("regressions", "hold")]
    arrays: Arrays = {name: np.asarray(getattr(prior, name)) for name in names}
    for view, regression in enumerate(prior.regressions):
        for field in fields(KernelRidge):
            value = getattr(regression, field.name)
            arrays[f"regression{view}.{field.name}"] = np.asarray(value)
    if prior.hold is not None:
        for field in fields(Hold):
            arrays[f"hold.{field.name}"] = np.asarray(getattr(prior.hold, field.name))
    return arrays


def prior_from_arrays(arrays: Arrays) -> Prior:
    """Put a prior together from the arrays of ``prior_to_arrays``."""
    views = takewhile(lambda view: f"regression{view}.width" in arrays, count())
    return Prior(
        arrays["centre"],
        arrays["spread"],
        tuple(_regression(arrays, f"regression{view}") for view in views),
        arrays["translation_products"].astype(np.float32),
        arrays["rotation_products"].astype(np.float32),
        arrays["errors"],
        float(arrays["calibration"]),
        float(arrays["persistence_s"]),
        _hold(arrays) if "hold.leanings" in arrays else None,
        float(arrays.get("widening", 0.0)),
    )


def _hold(arrays: Arrays) -> Hold:
    return Hold(
        int(arrays["hold.holder"]),
        arrays["hold.rotation"],
        arrays["hold.grip"],
        arrays["hold.pull"],
        arrays["hold.covariance"],
        arrays["hold.leanings"],
    )


def _regression(arrays: Arrays, name: str) -> KernelRidge:
    return KernelRidge(
        arrays[f"{name}.landmarks"].astype(np.float32),
        float(arrays[f"{name}.width"]),
        arrays[f"{name}.coefficients"],
        arrays[f"{name}.offset"],
    )

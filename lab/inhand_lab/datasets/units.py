"""Checks that joints and labels of a recording are in metres."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_schemas.joints import Joint
from inhand_schemas.messages import ObjectPose, Person, Skeletons
from inhand_tracker.body.skeleton import part_lengths, stature, typical_lengths
from inhand_tracker.body.stand_ins import TRUNK, seen_stature
from inhand_tracker.geometry.arrays import Array, Indices

from inhand_lab.datasets.dataset import DatasetError
from inhand_lab.datasets.parameters import DEFAULT_DATASET

UNITS_M = {
    "millimetres": 0.001,
    "centimetres": 0.01,
    "inches": 0.0254,
    "decimetres": 0.1,
    "feet": 0.3048,
    "kilometres": 1000.0,
}
"""Other units of length that joints and labels come in, each in metres."""

_TRUNK = [Joint.HIP_CENTER, Joint.SPINE, Joint.SHOULDER_CENTER, Joint.HEAD]


def check_units(
    path: Path, frames: Sequence[Skeletons], labels: Sequence[ObjectPose | None]
) -> None:
    """Check everybody's joints and the labels of T frames.

    Raises DatasetError for those that are in another unit than metres.
    """
    owners = np.array([index for index, frame in enumerate(frames) for _ in frame.people], int)
    joints = written_joints([person for frame in frames for person in frame.people])
    check_bodies(path, owners, joints, _places(labels))


def check_bodies(path: Path, owners: Indices, joints: Array, places: Array) -> None:
    """Check N bodies of frames ``owners`` (N,) with joints (N, 20, 3), and the ``places`` (T, 3) of
    T frames' labels, NaN without one; raises DatasetError as ``check_units`` does."""
    if not len(owners):
        return
    people = _BodiesWithLabels(owners, joints, places)
    with np.errstate(invalid="ignore", over="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of medians of nothing
        height, far = measured_stature(part_lengths(joints)), people.distance_m()
        trunks = np.linalg.norm(np.diff(joints[:, _TRUNK], axis=1), axis=2).sum(axis=1)
    _check_stature(path, height, far)
    _check_frames(path, owners, trunks)
    if far > DEFAULT_DATASET.farthest_label_m:
        raise DatasetError(
            f"{path}: the labels are {_number(far)} m away from everybody{people.label_unit()}: "
            "write metres in the camera's frame"
        )


@dataclass(frozen=True)
class _BodiesWithLabels:
    """Joints (N, 20, 3) of people, the numbers (N,) of their frames, places (T, 3) of labels."""

    frames: Indices
    joints: Array
    places: Array

    def distance_m(self, unit: float = 1.0) -> float:
        """Return how far labels are from the nearest joint, in the median; NaN without any."""
        places = unit * self.places
        distances = np.linalg.norm(self.joints - places[self.frames, None], axis=2)
        nearest = np.full(len(places), np.inf)
        np.fmin.at(nearest, self.frames, np.fmin.reduce(distances, axis=1))
        nearest = nearest[np.isfinite(nearest)]
        return float(np.median(nearest)) if len(nearest) else np.nan

    def label_unit(self) -> str:
        """Name the unit in which labels are at somebody; nothing where there is none."""
        distances = {name: self.distance_m(unit) for name, unit in UNITS_M.items()}
        unit = min(distances, key=distances.__getitem__)
        near = distances[unit] < DEFAULT_DATASET.held_label_m
        return f", and at somebody if they are in {unit}" if near else ""


def measured_stature(lengths: Array) -> float:
    """Return the stature by part lengths (N, 19), of trunk and legs, or else of arms and neck."""
    typical = typical_lengths(lengths)
    whole = stature(typical)
    return whole if np.isfinite(whole) else seen_stature(typical, TRUNK)


def unit_of_stature(height: float) -> str | None:
    """Name the unit in which people of that height are: metres, another, or None for no unit."""
    if DEFAULT_DATASET.smallest_stature_m <= height <= DEFAULT_DATASET.tallest_stature_m:
        return "metres"
    unit = min(UNITS_M, key=lambda name: _unlike_a_person(height * UNITS_M[name]))
    scaled = height * UNITS_M[unit]
    fits = DEFAULT_DATASET.smallest_stature_m <= scaled <= DEFAULT_DATASET.tallest_stature_m
    return unit if fits else None


def _check_stature(path: Path, height: float, far: float) -> None:
    unit = unit_of_stature(height)
    if not np.isfinite(height) or unit == "metres":
        return
    named = "in another unit" if unit is None else f"in {unit}"
    what = "joints and labels" if far <= height else "joints"
    raise DatasetError(
        f"{path}: a person {_number(height)} m tall: {what} are {named}; write metres"
    )


def _check_frames(path: Path, owners: Indices, trunks: Array) -> None:
    """Raise DatasetError where trunks, (N,) metres long, are of another unit in some frames."""
    usual = float(np.median(trunks[np.isfinite(trunks)])) if np.isfinite(trunks).any() else np.inf
    odd = np.flatnonzero(trunks > DEFAULT_DATASET.one_frame_ratio * usual)
    if len(odd):
        trunk, frame = trunks[odd[0]], owners[odd[0]]
        unit = min(UNITS_M, key=lambda name: abs(np.log(trunk / usual * UNITS_M[name])))
        raise DatasetError(
            f"{path}: the trunk is {_number(trunk)} m long in frame {frame}, and "
            f"{_number(usual)} m elsewhere: {len(odd)} of {len(trunks)} bodies seem to be in "
            f"{unit}; write metres"
        )


def written_joints(people: Sequence[Person]) -> Array:
    """Return joints (N, 20, 3) as they are written, however far away; NaN where missing."""
    if not people:
        return np.zeros((0, 20, 3))
    joints = np.array([person.joints for person in people])
    missing = [[state == "missing" for state in person.states] for person in people]
    joints[np.array(missing) | (joints == 0.0).all(axis=(1, 2))[:, None]] = np.nan
    return joints


def _places(labels: Sequence[ObjectPose | None]) -> Array:
    """Return where labels put the object (T, 3), NaN where they do not."""
    places = np.full((len(labels), 3), np.nan)
    for index, label in enumerate(labels):
        if label is not None and label.camera_from_object is not None:
            places[index] = label.camera_from_object.translation
    return places


def _unlike_a_person(height: float) -> float:
    return abs(float(np.log(max(height, 1e-12) / DEFAULT_DATASET.usual_stature_m)))


def _number(metres: float) -> str:
    return f"{metres:,.0f}" if metres >= 100.0 else f"{metres:.3g}"

"""Imports motion archives as datasets, as if a camera had been there."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from inhand_schemas.joints import Joint
from inhand_schemas.messages import Message
from inhand_tracker.body.skeleton import (
    Bases,
    has_pelvis,
    part_lengths,
    pelvis_basis,
    typical_lengths,
)
from inhand_tracker.body.stand_ins import REPLACEABLE, put_stand_ins, seen_stature
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.shape import ObjectShape

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.datasets.joint_names import named_joints
from inhand_lab.importers.messages import (
    PERSON,
    imagined_camera,
    imported_label,
    imported_skeletons,
)
from inhand_lab.importers.motion_archive import Motion, read_motion
from inhand_lab.importers.parameters import DEFAULT_IMPORT
from inhand_lab.importers.shapes import shape_of_mesh, shape_of_points
from inhand_lab.importers.sources import NobodyError, find_files, read_files
from inhand_lab.importers.timing import Timing, thin

_NEEDED = (Joint.SHOULDER_CENTER, Joint.HEAD, Joint.SHOULDER_LEFT, Joint.SHOULDER_RIGHT)
"""Joints by which an upper body is placed."""
_HALF_TURN_ABOUT_X = np.array([0.0, 1.0, 0.0, 0.0])


def import_motion(
    sources: Sequence[Path], folder: Path, frame_rate: float = DEFAULT_IMPORT.frame_rate
) -> Dataset:
    """Import archives, or folders of them, as skeletons and labels, one recording each.

    An archive of a body alone becomes a recording without labels, and one of an upper body one of
    that. Archives that cannot be read or show nobody are named and left out. Each recording is
    placed as a whole: the person stands upright 3 m before the camera and faces it when first seen.
    An ``.obj`` with the object's name beside the archive is its mesh; otherwise it is the convex
    hull of the marked points. The first archive that has an object gives its marked points; others
    may differ by 1 cm. Raises DatasetError where all archives are left out, or InhandError.
    """
    files = read_files(find_files(sources, ".npz"), lambda path: _read(path, frame_rate))
    shapes = _shapes([motion for motion, _ in files.recordings])
    writer = DatasetWriter(folder)
    for shape in shapes:
        writer.add_shape(shape)
    for motion, timing in files.recordings:
        entry = DatasetEntry(
            file=f"recordings/{motion.path.stem}.mcap",
            interaction=motion.interaction,
            participant=motion.participant,
            object=motion.object,
            handedness=motion.handedness,
            frame_rate=timing.frame_rate,
        )
        writer.add_recording(entry, _messages(motion, timing))
    files.report()
    return writer.finish({"importer": "motion"})


def world_in_camera(joints: Array) -> Bases:
    """Return the world frame in that of a camera 3 m before the person, facing them.

    ``joints`` (T, 20, 3) are in the world frame. Of the first pelvis that is seen, x (to the
    person's left) becomes the camera's x, y (up the spine) its -y, and z (forwards) its -z. Of an
    upper body it is where the shoulders and the neck put it. Raises NobodyError where they do not.
    """
    seen = np.asarray(np.asarray(np.isfinite(joints).all(axis=2)).any(axis=0))
    absent = [joint for joint in REPLACEABLE if not seen[joint]]
    placed = joints
    if absent:
        height = seen_stature(typical_lengths(part_lengths(joints)), absent)
        placed = put_stand_ins(joints, absent, height)
    first = next((frame for frame in placed if has_pelvis(frame)), None)
    if first is None:
        raise NobodyError(
            f"no frame shows where a body faces: {named_joints(_NEEDED)} of it are never seen "
            f"together; {named_joints(np.flatnonzero(~seen).tolist())} never at all"
        )
    pelvis = pelvis_basis(first)
    rotation = rotations.multiply(_HALF_TURN_ABOUT_X, rotations.conjugate(pelvis.rotations))
    centre = np.array([0.0, 0.0, DEFAULT_IMPORT.distance_m])
    return Bases(centre - rotations.rotate(rotation, pelvis.origins), rotation)


def _read(path: Path, frame_rate: float) -> tuple[Motion, Timing]:
    """Read an archive that can be placed and thinned; raises DatasetError."""
    motion = read_motion(path)
    try:
        world_in_camera(motion.joints)
    except NobodyError as error:
        raise NobodyError(f"{path}: {error}") from None
    return motion, thin(path, motion.recorded_rate, frame_rate)


def _messages(motion: Motion, timing: Timing) -> Iterator[Message]:
    world = world_in_camera(motion.joints)
    joints = world.origins + rotations.rotate(world.rotations, motion.joints)
    translations, orientations = world.to_camera(motion.translations, motion.orientations)
    where = f"imagined {DEFAULT_IMPORT.distance_m:g} m before the person of {motion.path.name}"
    yield imagined_camera(timing.time_ns(0), where, timing.frame_rate)
    for sequence, frame in enumerate(range(0, len(joints), timing.step)):
        time_ns = timing.time_ns(sequence)
        yield imported_skeletons(sequence, time_ns, joints[frame])
        translation, orientation = translations[frame], orientations[frame]
        if motion.object is not None and np.isfinite(translation).all():
            yield imported_label(sequence, time_ns, motion.object, translation, orientation, PERSON)


def _shapes(motions: Sequence[Motion]) -> list[ObjectShape]:
    first: dict[str, Motion] = {}
    for motion in motions:
        if motion.object is None:
            continue
        other = first.setdefault(motion.object, motion)
        same_points = other.marked_vertices.shape == motion.marked_vertices.shape and np.allclose(
            other.marked_vertices,
            motion.marked_vertices,
            rtol=0.0,
            atol=DEFAULT_IMPORT.same_point_m,
        )
        if not same_points:
            raise DatasetError(
                f"{other.path} and {motion.path} mark other points of {motion.object!r}: import "
                "them into two datasets"
            )
    return [_shape(name, motion) for name, motion in first.items()]


def _shape(name: str, motion: Motion) -> ObjectShape:
    plain_name = name.replace("_", "")
    for mesh in sorted(motion.path.parent.glob("*.obj")):
        if mesh.stem.lower().replace("_", "") == plain_name:
            return shape_of_mesh(name, mesh, motion.marked_vertices)
    return shape_of_points(name, motion.marked_vertices, motion.marked_vertices)

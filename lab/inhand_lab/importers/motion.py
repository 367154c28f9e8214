"""Motion archives as datasets, seen by a camera that was not there."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from inhand_schemas.messages import CameraInfo, Message
from inhand_tracker.body.skeleton import Bases, has_pelvis, pelvis_basis
from inhand_tracker.geometry import rotations
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.shape.shape import ObjectShape

from inhand_lab.datasets.dataset import Dataset, DatasetEntry, DatasetError
from inhand_lab.datasets.dataset_writer import DatasetWriter
from inhand_lab.importers.messages import PERSON, imported_label, imported_skeletons
from inhand_lab.importers.motion_archive import Motion, read_motion
from inhand_lab.importers.shapes import shape_of_mesh, shape_of_points
from inhand_lab.importers.sources import find_files
from inhand_lab.importers.timing import FRAME_RATE, Timing, thin

DISTANCE_M = 3.0
SAME_POINT_M = 0.01

_HALF_TURN_ABOUT_X = np.array([0.0, 1.0, 0.0, 0.0])


def import_motion(sources: Sequence[Path], folder: Path, frame_rate: float = FRAME_RATE) -> Dataset:
    """Archives, or folders of them, as a dataset of skeletons and labels, one recording each.

    Each recording is placed as a whole: the person stands upright 3 m before the camera and faces
    it when first seen. An ``.obj`` with the object's name beside the archive is its mesh;
    otherwise it is the convex hull of the marked points. The first archive that has an object
    tells its marked points; others may differ by 1 cm. Raises DatasetError or InhandError.
    """
    motions = [read_motion(path) for path in find_files(sources, ".npz")]
    timings = [thin(motion.path, motion.recorded_rate, frame_rate) for motion in motions]
    shapes = _shapes(motions)
    writer = DatasetWriter(folder)
    for shape in shapes:
        writer.add_shape(shape)
    for motion, timing in zip(motions, timings, strict=True):
        entry = DatasetEntry(
            file=f"recordings/{motion.path.stem}.mcap",
            interaction=motion.interaction,
            participant=motion.participant,
            object=motion.object,
            handedness=motion.handedness,
            frame_rate=timing.frame_rate,
        )
        writer.add_recording(entry, _messages(motion, timing))
    return writer.finish({"importer": "motion"})


def world_in_camera(joints: Array) -> Bases:
    """The world frame as a camera sees it that stands 3 m before the person and faces them.

    ``joints`` (T, 20, 3) are in the world frame. Of the first pelvis that is seen, x (to the
    person's left) becomes the camera's x, y (up the spine) its -y, and z (forwards) its -z.
    """
    pelvis = pelvis_basis(next(frame for frame in joints if has_pelvis(frame)))
    rotation = rotations.multiply(_HALF_TURN_ABOUT_X, rotations.conjugate(pelvis.rotations))
    centre = np.array([0.0, 0.0, DISTANCE_M])
    return Bases(centre - rotations.rotate(rotation, pelvis.origins), rotation)


def _messages(motion: Motion, timing: Timing) -> Iterator[Message]:
    world = world_in_camera(motion.joints)
    joints = world.origins + rotations.rotate(world.rotations, motion.joints)
    translations, orientations = world.to_camera(motion.translations, motion.orientations)
    yield CameraInfo(
        sequence=0,
        time_ns=timing.time_ns(0),
        width=640,
        height=480,
        fx=525.0,
        fy=525.0,
        cx=319.5,
        cy=239.5,
        frame_rate=timing.frame_rate,
        has_colour=False,
        has_depth=False,
        description=f"imagined 3 m before the person of {motion.path.name}",
    )
    for sequence, frame in enumerate(range(0, len(joints), timing.step)):
        time_ns = timing.time_ns(sequence)
        yield imported_skeletons(sequence, time_ns, joints[frame])
        translation, orientation = translations[frame], orientations[frame]
        if np.isfinite(translation).all():
            yield imported_label(sequence, time_ns, motion.object, translation, orientation, PERSON)


def _shapes(motions: Sequence[Motion]) -> list[ObjectShape]:
    first: dict[str, Motion] = {}
    for motion in motions:
        known = first.setdefault(motion.object, motion)
        same_points = known.marked_vertices.shape == motion.marked_vertices.shape and np.allclose(
            known.marked_vertices, motion.marked_vertices, rtol=0.0, atol=SAME_POINT_M
        )
        if not same_points:
            raise DatasetError(
                f"{known.path} and {motion.path} mark other points of {motion.object!r}: import "
                "them into two datasets"
            )
    return [_shape(motion) for motion in first.values()]


def _shape(motion: Motion) -> ObjectShape:
    plain_name = motion.object.replace("_", "")
    for mesh in sorted(motion.path.parent.glob("*.obj")):
        if mesh.stem.lower().replace("_", "") == plain_name:
            return shape_of_mesh(motion.object, mesh, motion.marked_vertices)
    return shape_of_points(motion.object, motion.marked_vertices, motion.marked_vertices)

"""Shows a recording to trackers as their daemon would: bodies and images, no labels."""

from collections.abc import Collection, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from inhand_schemas.conventions import SIMULATED
from inhand_schemas.errors import MessageError
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.estimate import Estimate
from inhand_tracker.geometry.image import Image
from inhand_tracker.methods.object_tracker import ObjectTracker
from inhand_tracker.wire.conversion import Need, image_of, joints_of

from inhand_lab.datasets.followed_people import follow_people
from inhand_lab.datasets.frame_pixels import pixels_of
from inhand_lab.datasets.recorded_frames import (
    RecordedFrame,
    labelled_camera,
    load_camera_info,
)
from inhand_lab.datasets.tracks import Track, empty_track
from inhand_lab.world.messages import camera_info, person_message, pixels_message
from inhand_lab.world.simulation import Simulation

_NO_PIXELS = (-1, None)


@dataclass(frozen=True)
class Observation:
    """One frame as a tracker sees it.

    ``joints`` (20, 3) are those of the person followed, None where nobody is seen; ``image`` is
    None where there are no pixels, or none are needed. ``somebody_else`` is true where another
    person is followed from this frame on; ``convention`` names whose joints they are.
    """

    time_ns: int
    joints: Array | None
    image: Image | None
    somebody_else: bool
    convention: str | None = None

    def show(self, tracker: ObjectTracker) -> Estimate:
        """Show the frame to a tracker, and return its estimate."""
        if self.somebody_else:
            tracker.restart()
        tracker.convention = self.convention
        return tracker.step(self.joints, self.time_ns, self.image)


def observe(
    path: Path, frames: Sequence[RecordedFrame], needs: Collection[Need] = ()
) -> Iterator[Observation]:
    """Yield the frames of a recording in order; raises RecordingError.

    Pixels are read and decoded once, and only those that are needed. A damaged image counts as
    none.
    """
    name = labelled_camera(frames)
    info = load_camera_info(path, name) if needs else None
    pixels = pixels_of(path, frames, name) if info is not None else iter(())
    number, current = next(pixels, _NO_PIXELS)
    for index, (frame, followed) in enumerate(zip(frames, follow_people(frames), strict=True)):
        image = None
        if info is not None and current is not None and number == index:
            with suppress(MessageError):
                image = image_of(current, info, needs)
            number, current = next(pixels, _NO_PIXELS)
        joints = None if followed.person is None else joints_of(followed.person)
        yield Observation(frame.time_ns, joints, image, followed.somebody_else, frame.convention)


def observe_simulation(
    simulation: Simulation, needs: Collection[Need] = ()
) -> Iterator[Observation]:
    """Yield the frames of a simulation as if they came from a camera."""
    info = camera_info(simulation.intrinsics, simulation.frame_rate)
    for frame in range(simulation.frames):
        time_ns = round(frame * 1e9 / simulation.frame_rate)
        joints = joints_of(person_message(simulation, frame))
        image = None
        if needs:
            seen = simulation.render(frame)
            image = image_of(pixels_message(seen, sequence=frame, time_ns=time_ns), info, needs)
        yield Observation(time_ns, joints, image, False, SIMULATED)


def track_together(
    trackers: Sequence[ObjectTracker],
    path: Path,
    frames: Sequence[RecordedFrame],
    needs: Collection[Need],
) -> tuple[Array, list[Track]]:
    """Return the joints (T, 20, 3) that several trackers saw of a recording, and their tracks.

    The trackers share their model and the person's handedness, so each body is read once for all.
    """
    joints = np.full((len(frames), 20, 3), np.nan)
    tracks = [empty_track(len(frames)) for _ in trackers]
    reader = trackers[0].new_reader()
    for index, seen in enumerate(observe(path, frames, needs)):
        if seen.somebody_else:
            reader = trackers[0].new_reader()
        body = None
        if seen.joints is not None:
            joints[index] = seen.joints
            body = reader.read(seen.joints, seen.convention)
        for tracker, track in zip(trackers, tracks, strict=True):
            if seen.somebody_else:
                tracker.restart()
            track.put(index, tracker.step_body(body, seen.time_ns, seen.image))
    return joints, tracks

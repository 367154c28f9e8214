"""Poses of an object between a person's keyframes (Darby et al. 2014, section 6).

Two keyframes in succession say what holds between them: poses on the way from one to the other, or
that the object is absent. Between a pose and an absence nothing is known, nor before the first
keyframe and after the last.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from inhand_tracker.body.skeleton import Bases
from inhand_tracker.geometry.arrays import Array, Flags, Indices
from inhand_tracker.shape.shape import Symmetry

from inhand_lab.labelling.body_parts import filled, part_of
from inhand_lab.labelling.equal_poses import Pose, nearest_equal
from inhand_lab.labelling.keyframes import Keyframe
from inhand_lab.labelling.parameters import DEFAULT_LABELLING, LabellingParameters
from inhand_lab.labelling.turning import between


@dataclass(frozen=True)
class Stretch:
    """The frames from one posed keyframe to the next, ``first`` to ``last``."""

    first: int
    last: int

    @property
    def inner(self) -> slice:
        """The frames between the two keyframes."""
        return slice(self.first + 1, self.last)


@dataclass(frozen=True)
class Interpolated:
    """Poses camera_from_object of T frames, (T, 3) and (T, 4), NaN where there is none.

    ``absent`` (T,) flags frames in which the object is absent by the keyframes. ``stretches`` are
    those with frames that got poses, and ``notes`` say why others did not, or not as they were
    asked for.
    """

    translations: Array
    rotations: Array
    absent: Flags
    stretches: tuple[Stretch, ...]
    notes: tuple[str, ...]


def interpolate(
    keyframes: Sequence[Keyframe],
    times_ns: Indices,
    joints: Array,
    symmetries: Sequence[Symmetry] = (),
    parameters: LabellingParameters = DEFAULT_LABELLING,
) -> Interpolated:
    """Find the poses of T frames, with ``times_ns`` (T,) and one person's joints (T, 20, 3).

    A keyframe's own frame has its pose, or one that looks the same: that which is turned least from
    the keyframe before, by the object's ``symmetries``. Keyframes are in the order of their frames.
    """
    translations, turns = np.full((len(times_ns), 3), np.nan), np.full((len(times_ns), 4), np.nan)
    absent = np.zeros(len(times_ns), bool)
    stretches: list[Stretch] = []
    notes: list[str] = []
    for index, keyframe in enumerate(keyframes):
        before = keyframes[index - 1] if index else None
        if keyframe.pose is None:
            both = before is not None and before.pose is None
            absent[before.frame if before and both else keyframe.frame : keyframe.frame + 1] = True
            continue
        frame, pose = keyframe.frame, keyframe.pose
        if before is None or before.pose is None:
            translations[frame], turns[frame] = pose
            continue
        stretch = Stretch(before.frame, frame)
        start = translations[before.frame], turns[before.frame]
        basis, note = _basis(before.relative_to, stretch, times_ns, joints)
        notes += note
        end, inner = _way(start, pose, stretch, basis, times_ns, symmetries)
        translations[frame], turns[frame] = end
        if broken := _broken(stretch, times_ns, parameters):
            notes.append(broken)
            continue
        if frame > stretch.first + 1:
            translations[stretch.inner], turns[stretch.inner] = inner
            stretches.append(stretch)
    return Interpolated(translations, turns, absent, tuple(stretches), tuple(notes))


def _way(
    start: Pose,
    end: Pose,
    stretch: Stretch,
    basis: Bases | None,
    times_ns: Indices,
    symmetries: Sequence[Symmetry],
) -> tuple[Pose, tuple[Array, Array]]:
    """Return the end that is equal and nearest to the start, and the poses between both."""
    times = times_ns[stretch.first : stretch.last + 1]
    shares = (times - times[0])[1:-1] / max(times[-1] - times[0], 1)
    if basis is None:
        equal = nearest_equal(end, start, symmetries)
        return equal, between(start, equal, shares)
    bases = [Bases(basis.origins[one], basis.rotations[one]) for one in (0, -1)]
    start = bases[0].from_camera(*start)
    equal = nearest_equal(bases[1].from_camera(*end), start, symmetries)
    moving = Bases(basis.origins[1:-1], basis.rotations[1:-1])
    return bases[1].to_camera(*equal), moving.to_camera(*between(start, equal, shares))


def _basis(
    name: str | None, stretch: Stretch, times_ns: Indices, joints: Array
) -> tuple[Bases | None, list[str]]:
    """Return a body part's basis in every frame of a stretch, or None for the camera and why."""
    if name is None:
        return None, []
    whole = slice(stretch.first, stretch.last + 1)
    part = part_of(joints[whole], name)
    missing = ~np.isfinite(part.origins[:, 0])
    if missing[0] or missing[-1]:
        frame = stretch.first if missing[0] else stretch.last
        return None, [
            f"frames {stretch.first} to {stretch.last} are interpolated in the camera's frame: the "
            f"{name} is not seen in frame {frame}; move the keyframe to where it is"
        ]
    return filled(part, times_ns[whole]), []


def _broken(stretch: Stretch, times_ns: Indices, parameters: LabellingParameters) -> str | None:
    """Say why nothing is known between two keyframes; None where their frames follow in time."""
    steps = np.diff(times_ns[stretch.first : stretch.last + 1])
    named = f"frames {stretch.first + 1} to {stretch.last - 1} get no label: "
    if len(steps) < 2:
        return None
    if (steps <= 0).any():
        frame = stretch.first + 1 + int(np.argmax(steps <= 0))
        return (
            f"{named}time stands still or runs backwards at frame {frame}; put a keyframe on "
            "either side of it"
        )
    if (steps > 1e9 * parameters.longest_step_s).any():
        frame = stretch.first + 1 + int(np.argmax(steps))
        return (
            f"{named}{steps.max() / 1e9:.1f} s are missing before frame {frame}; put a keyframe on "
            "either side of the gap"
        )
    return None

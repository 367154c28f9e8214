"""What is shown together: a picture with the people and the objects that are in it."""

from collections.abc import Sequence
from dataclasses import dataclass

from inhand_schemas.messages import ObjectPose, Skeletons

from inhand_studio.live_page.parameters import LiveParameters
from inhand_studio.picture import Picture
from inhand_studio.rig import CameraNews


@dataclass(frozen=True)
class Moment:
    """A picture, if any, and the people and objects in it; or, without one, the newest of both.

    ``objects`` holds one pose of each object, or several where several people use it.
    """

    picture: Picture | None
    people: Skeletons | None
    objects: tuple[ObjectPose, ...]


def moment_of(news: CameraNews, now_s: float, parameters: LiveParameters) -> Moment:
    """Choose what is shown at a time, ``now_s`` by the clock that nobody sets.

    A picture comes before the poses that are estimated from it, and waits for them as long as
    poses come at all.
    """
    picture = _newest_estimated(news, now_s, parameters)
    until = None if picture is None else picture.sequence
    people = next((one for one in reversed(news.skeletons) if _is_until(one, until)), None)
    objects = newest_poses(news.poses, until)
    times = [one.time_ns for one in (picture, people, *objects) if one is not None]
    latest = picture.time_ns if picture is not None else max(times, default=0)
    if people is not None and abs(latest - people.time_ns) > parameters.hold_ns:
        people = None
    kept = tuple(one for one in objects if abs(latest - one.time_ns) <= parameters.hold_ns)
    return Moment(picture, people, kept)


def newest_poses(poses: Sequence[ObjectPose], until: int | None = None) -> tuple[ObjectPose, ...]:
    """Return the last poses of each object, by its name, of those up to a frame's number."""
    chosen: dict[str, list[ObjectPose]] = {}
    for pose in reversed(poses):
        if _is_until(pose, until):
            same = chosen.setdefault(pose.object, [])
            if not same or same[0].sequence == pose.sequence:
                same.append(pose)
    return tuple(pose for name in sorted(chosen) for pose in reversed(chosen[name]))


def _newest_estimated(news: CameraNews, now_s: float, parameters: LiveParameters) -> Picture | None:
    """Return the newest picture whose poses came already, or the newest where no poses come."""
    if not news.pictures:
        return None
    newest = news.pictures[-1]
    if not news.poses or news.poses_at is None:
        return newest
    if now_s - news.poses_at > parameters.poses_missed_s:
        return newest
    last = max(pose.sequence for pose in news.poses[-parameters.late_poses :])
    return next((one for one in reversed(news.pictures) if one.sequence <= last), newest)


def _is_until(message: Skeletons | ObjectPose, sequence: int | None) -> bool:
    return sequence is None or message.sequence <= sequence

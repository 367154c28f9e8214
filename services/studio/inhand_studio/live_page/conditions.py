"""What keeps a tab from showing what it should, and how to mend it, a sentence each."""

import time

from inhand_runtime.roll import Heard, Instance
from inhand_schemas.messages import CameraInfo, ObjectPose

from inhand_studio.live_page.parameters import LiveParameters
from inhand_studio.rig import Pictures, Rig


def no_camera(rig: Rig) -> str:
    """Say why there is no camera to look at."""
    if rig.is_alone():
        return (
            f"No process of rig {rig.name} is connected: start it with `inhand up`, or check the "
            "addresses in the settings of this studio, [zenoh]. The page goes on by itself."
        )
    return (
        f"No camera of rig {rig.name} has described itself yet: start one with `inhand capture`. "
        "The page goes on by itself."
    )


def conditions_of(
    camera: str, info: CameraInfo, pictures: Pictures | None, rig: Rig, parameters: LiveParameters
) -> list[str]:
    """Say what is not seen of a camera's pictures and people now, and why."""
    living, news = rig.roll.living(), rig.heard(camera, pictures)
    if _is_shut(camera, living):
        return [
            f"The shutter of {camera} is closed: nothing is captured until `inhand shutter open "
            f"--camera {camera}`."
        ]
    now = time.monotonic()
    lines = []
    shown = news.pictures[-1].arrived if news.pictures else None
    if pictures is not None and not (info.has_colour or info.has_depth):
        lines.append(f"{camera} takes no pictures: only skeletons are shown.")
    elif pictures is not None and _is_silent(shown, now, parameters):
        since = "yet" if shown is None else f"for {now - shown:.0f} s"
        lines.append(f"No picture of {camera} came {since}: {_absence(camera, living)}.")
    if _is_silent(news.skeletons_at, now, parameters):
        since = "yet" if news.skeletons_at is None else f"for {now - news.skeletons_at:.0f} s"
        lines.append(f"No skeletons of {camera} came {since}: {_absence(camera, living)}.")
    elif news.skeletons and not news.skeletons[-1].people:
        lines.append("Nobody is in view.")
    return lines


def age_text(pose: ObjectPose, now_ns: int, parameters: LiveParameters) -> str:
    """Say how long ago the frame of a pose was captured."""
    age_ms = (now_ns - pose.time_ns) / 1e6
    if abs(age_ms) > parameters.longest_age_ms or age_ms < -parameters.wait_s * 1e3:
        return "unknown: a clock was set, or two machines' clocks differ"
    return f"{max(age_ms, 0.0):.0f} ms"


def _is_silent(at: float | None, now: float, parameters: LiveParameters) -> bool:
    return at is None or now - at > parameters.silent_s


def _absence(camera: str, living: dict[Instance, Heard | None]) -> str:
    """Say why a camera says nothing."""
    sources = [heard for one, heard in living.items() if one == ("capture", camera)]
    if not sources:
        return "its process has ended, or cannot be reached from here"
    if sources[0] is not None and sources[0].health.troubles:
        return "; ".join(sources[0].health.troubles)
    return "its process is there, and sends none"


def without_poses(
    camera: str, pictures: Pictures | None, rig: Rig, parameters: LiveParameters
) -> list[str]:
    """Say why no poses of a camera's objects come; nothing where some do, or its shutter is
    closed."""
    living, news, now = rig.roll.living(), rig.heard(camera, pictures), time.monotonic()
    if _is_shut(camera, living) or not _is_silent(news.poses_at, now, parameters):
        return []
    named = ", ".join(name for service, name in living if service == "tracker")
    if not named:
        return ["No tracker runs: objects are not tracked. Start one with `inhand tracker`."]
    if news.poses_at is None:
        return [f"No pose of {camera} came yet: of the trackers {named} perhaps none looks at it."]
    return [f"No pose came for {now - news.poses_at:.0f} s from the trackers {named}."]


def _is_shut(camera: str, living: dict[Instance, Heard | None]) -> bool:
    source = next((heard for one, heard in living.items() if one == ("capture", camera)), None)
    return source is not None and bool(source.health.shutter_closed)

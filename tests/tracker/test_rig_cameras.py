"""One tracker follows what several cameras see, from messages to messages."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from inhand_runtime.pixels import encode_colour
from inhand_runtime.rig_calibration import CameraCalibration, RigCalibration, write_rig_calibration
from inhand_schemas.messages import CameraInfo, ObjectPose, Pose, RgbdFrame, Skeletons
from inhand_schemas.topics import INFO, RGBD, SKELETONS
from inhand_tracker import rig_cameras
from inhand_tracker.geometry.arrays import Array
from inhand_tracker.geometry.estimate import Estimate
from inhand_tracker.geometry.image import Image, ViewPull
from inhand_tracker.geometry.placement import Placement
from inhand_tracker.methods.fusion.tracker import FusionTracker
from inhand_tracker.people.watching import GivenObjects
from inhand_tracker.service import TrackerService
from inhand_tracker.settings import TrackerSettings
from people import unseen_wave, wave_model
from rig_people import PLACES, person_seen
from simulated_daemon import DueOf, SimulatedDaemon

PERIOD_S = 1.0 / 30.0
EPOCH_S = 1000.0
PHASES_S = {"front": 0.02, "left": 0.03, "right": 0.012}
PICTURE = encode_colour(np.full((48, 64, 3), 90, np.uint8))
BLIND: dict[str, object] = {"likelihood": ()}
"""Settings by which bodies alone say where an object is."""


def pose_of(place: Placement) -> Pose:
    x, y, z = place.translation.tolist()
    a, b, c, d = place.rotation.tolist()
    return Pose((x, y, z), (a, b, c, d))


@dataclass(frozen=True)
class RigFilm:
    """Somebody waves before cameras that say where they are; some die, some are elsewhere by
    metres (3,), some clocks are wrong, and some have only one frame of so many."""

    frames: int = 60
    cameras: tuple[str, ...] = ("front", "left", "right")
    dies_s: Mapping[str, float] = field(default_factory=dict)
    off_m: Mapping[str, float] = field(default_factory=dict)
    clocks_s: Mapping[str, float] = field(default_factory=dict)
    one_of: Mapping[str, int] = field(default_factory=dict)
    pictures: bool = False
    says_place: bool = True

    def messages(self) -> list[DueOf]:
        wave, sent = unseen_wave(self.frames), []
        for camera in self.cameras:
            place = PLACES[camera]
            said = {"rig_from_camera": pose_of(place)} if self.says_place else {}
            info = CameraInfo(
                sequence=0, time_ns=0, width=64, height=48, fx=52.0, fy=52.0, cx=31.5, cy=23.5,
                **said,
            )  # fmt: skip
            sent.append((0.0, INFO, info, camera))
            for number, joints in enumerate(wave):
                at = PHASES_S[camera] + number * PERIOD_S
                if at > self.dies_s.get(camera, np.inf):
                    break
                if number % self.one_of.get(camera, 1):
                    continue
                time_ns = round(1e9 * (EPOCH_S + at + self.clocks_s.get(camera, 0.0)))
                elsewhere = joints + np.array([self.off_m.get(camera, 0.0), 0.0, 0.0])
                people = (person_seen(elsewhere, place),)
                stamp = {"sequence": number, "time_ns": time_ns}
                sent.append((at + 0.004, SKELETONS, Skeletons(**stamp, people=people), camera))
                if self.pictures:
                    frame = RgbdFrame(**stamp, colour=PICTURE)
                    sent.append((at + 0.008, RGBD, frame, camera))
        return sent


class ShownAside(FusionTracker):
    """Says of each picture that something 2.5 m ahead is 5 cm lower in the left one than in the
    front one."""

    def step(self, joints: Array | None, time_ns: int, image: Image | None = None) -> Estimate:
        if image is not None and image.on_pulls is not None:
            at, information = np.array([0.0, 0.0, 2.5]), np.diag([1e4] * 3 + [1e2] * 3)
            image.on_pulls(
                [
                    ViewPull(camera, at, np.array([0.0, low, 0.0, 0.0, 0.0, 0.0]), information)
                    for camera, low in (("front", 0.0), ("left", 0.05))
                ]
            )
        return super().step(joints, time_ns, image)


def tracked(
    film: RigFilm, kind: type[FusionTracker] = FusionTracker, **settings: object
) -> SimulatedDaemon:
    daemon = SimulatedDaemon(*film.messages())
    chosen = TrackerSettings(cameras=film.cameras, **(BLIND | settings))
    terms = ["region"] if film.pictures else []
    tracker = kind(wave_model(), terms=terms, several_cameras=film.pictures)
    TrackerService(daemon, chosen, lambda: GivenObjects({"mug": tracker}), daemon.clock).run()
    return daemon


def in_rig(poses: list[ObjectPose]) -> np.ndarray:
    return np.array([pose.rig_from_object.translation for pose in poses])


def troubles(daemon: SimulatedDaemon) -> str:
    return " | ".join(daemon.health.report().troubles)


def test_each_moment_of_the_first_camera_gives_one_pose_in_its_frame_and_in_the_rig_s() -> None:
    daemon = tracked(RigFilm())
    poses = daemon.poses["mug"]
    assert [pose.sequence for pose in poses[1:]] == list(range(1, 60))
    assert {pose.camera for pose in poses[1:]} == {"front"}
    alone = tracked(RigFilm(cameras=("front",))).poses["mug"]
    where = np.array([pose.camera_from_object.translation for pose in poses[10:]])
    expected = np.array([pose.camera_from_object.translation for pose in alone[10:]])
    assert np.linalg.norm(where - expected, axis=1).max() < 0.02
    assert in_rig(poses[10:]) == pytest.approx(where)


def test_when_the_first_camera_dies_another_goes_on_and_nothing_leaps() -> None:
    daemon = tracked(RigFilm(dies_s={"front": 1.0}))
    poses = daemon.poses["mug"]
    assert [pose.camera for pose in poses[-20:]] == ["left"] * 20
    assert all(pose.state == "tracked" for pose in poses)
    times_ns = [pose.time_ns for pose in poses]
    assert max(b - a for a, b in pairwise(times_ns)) < 2e9 * PERIOD_S
    whole = tracked(RigFilm()).poses["mug"]
    usual = np.linalg.norm(np.diff(in_rig(whole[5:]), axis=0), axis=1).max()
    assert np.linalg.norm(np.diff(in_rig(poses[5:]), axis=0), axis=1).max() < usual + 0.02
    left = poses[-1]
    from_left = PLACES["left"].points(np.array(left.camera_from_object.translation))
    # People who move, seen a moment later, have moved the camera a little.
    assert left.rig_from_object.translation == pytest.approx(from_left, abs=0.002)


def test_poses_are_young_whatever_the_cameras_do() -> None:
    daemon = tracked(RigFilm(pictures=True, dies_s={"right": 0.7}), likelihood=("region",))
    times_s = np.array([pose.time_ns / 1e9 - EPOCH_S for pose in daemon.poses["mug"]])
    assert np.percentile(np.array(daemon.published) - times_s, 99) < 0.06
    assert len(times_s) >= 59


def test_frames_are_decoded_once_each_and_while_a_moment_still_waits_for_others(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    frames, decoded = [], rig_cameras.decoded

    def noted(daemon: SimulatedDaemon, camera: str, frame: RgbdFrame, *rest: Any) -> Image | None:
        frames.append((camera, frame.sequence, daemon.clock()))
        return decoded(daemon, camera, frame, *rest)

    monkeypatch.setattr(rig_cameras, "decoded", noted)
    tracked(RigFilm(pictures=True), likelihood=("region",))
    assert len({frame[:2] for frame in frames}) == len(frames) > 170
    # The left camera's frames come last; the right one's do 18 ms before them.
    begun = {(camera, number): at for camera, number, at in frames if number > 5}
    waited_s = [at - begun["right", number] for (camera, number), at in begun.items()
                if camera == "left" and ("right", number) in begun]  # fmt: skip
    assert len(waited_s) > 40
    assert min(waited_s) > 0.01


def test_cameras_of_another_rate_cost_no_pose_and_no_trouble() -> None:
    daemon = tracked(RigFilm(one_of={"left": 3, "right": 2}))
    poses = daemon.poses["mug"]
    assert [pose.sequence for pose in poses[1:]] == list(range(1, 60))
    assert {pose.camera for pose in poses[1:]} == {"front"}
    assert troubles(daemon) == ""
    whole = in_rig(tracked(RigFilm()).poses["mug"])
    assert np.linalg.norm(in_rig(poses) - whole, axis=1)[10:].max() < 0.02


def test_a_camera_that_somebody_bumped_is_said_and_adds_nothing() -> None:
    daemon = tracked(RigFilm(frames=150, off_m={"left": 0.14}))
    assert "left disagrees by 14 cm with the others" in troubles(daemon)
    right = tracked(RigFilm(frames=150)).poses["mug"]
    off = in_rig(daemon.poses["mug"][-20:]) - in_rig(right[-20:])
    assert np.linalg.norm(off, axis=1).max() < 0.01


def test_a_camera_is_said_that_stands_farther_off_than_its_calibration_allows(
    tmp_path: Path,
) -> None:
    film = RigFilm(frames=45, pictures=True)
    sure = calibrated(tmp_path, deviation=0.001)
    daemon = tracked(film, ShownAside, likelihood=("region",), calibration=sure)
    assert re.search(r"what left sees is \d\.\d cm off, which is more than its", troubles(daemon))
    unsure = calibrated(tmp_path, deviation=0.03)
    daemon = tracked(film, ShownAside, likelihood=("region",), calibration=unsure)
    assert "calibration" not in troubles(daemon)


@pytest.mark.parametrize("camera", ["front", "right"])
def test_a_clock_that_is_two_seconds_off_is_said(camera: str) -> None:
    daemon = tracked(RigFilm(clocks_s={camera: 2.0}))
    assert f"{camera}'s clock is 2.0 s ahead of the others'" in troubles(daemon)
    assert camera not in {pose.camera for pose in daemon.poses["mug"][10:]}
    assert len(daemon.poses["mug"]) >= 55


def calibrated(path: Path, deviation: float = 0.01, **offsets_s: float) -> Path:
    made = datetime.now(UTC)
    cameras = {
        camera: CameraCalibration(
            pose_of(PLACES[camera]),
            (deviation,) * 3,
            (deviation,) * 3,
            "people",
            made,
            round(1e9 * offsets_s.get(camera, 0.0)),
            1_000_000,
        )
        for camera in PLACES
    }
    write_rig_calibration(path / "rig.toml", RigCalibration(cameras))
    return path / "rig.toml"


def test_a_calibration_says_where_cameras_are_and_how_their_clocks_differ(tmp_path: Path) -> None:
    film = RigFilm(clocks_s={"left": 2.0}, says_place=False)
    daemon = tracked(film, calibration=calibrated(tmp_path, left=-2.0))
    assert "clock" not in troubles(daemon)
    assert "place" not in troubles(daemon)
    usual = tracked(RigFilm()).poses["mug"]
    assert in_rig(daemon.poses["mug"][-20:]) == pytest.approx(in_rig(usual[-20:]), abs=1e-4)


def test_a_calibration_that_is_written_anew_meanwhile_is_said(tmp_path: Path) -> None:
    film, path = RigFilm(frames=90), calibrated(tmp_path)
    daemon = SimulatedDaemon(*film.messages())
    chosen = TrackerSettings(cameras=film.cameras, calibration=path, **BLIND)
    tracker = FusionTracker(wave_model(), terms=[])
    service = TrackerService(daemon, chosen, lambda: GivenObjects({"mug": tracker}), daemon.clock)
    calibrated(tmp_path, left=-2.0)
    service.run()
    assert "rig.toml was written anew" in troubles(daemon)


def test_cameras_of_which_nobody_said_where_they_are_are_said() -> None:
    daemon = tracked(RigFilm(says_place=False))
    assert "left and front are said to be at the same place" in troubles(daemon)
    assert {pose.camera for pose in daemon.poses["mug"]} <= {"front", "right", "left"}


def test_settings_of_more_cameras_than_a_moment_can_have_are_refused() -> None:
    with pytest.raises(ValueError, match="at most 4"):
        TrackerSettings(cameras=("a", "b", "c", "d", "e"))

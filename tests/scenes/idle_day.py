"""What outcomes say of people who use nothing, and of things used as others: run by hand.

``python tests/scenes/idle_day.py --hours 1 --seed 6001`` lets simulated people stand, gesture, walk
and fidget beside all fifteen things, whose poses err as a tracker's do, and prints how many events
of each kind were said that hour, and what saying them cost. Three tellers of poses:

``unseen``: the tracker itself, without images, which says where it would be (a minute of it);
``lying``: things that lie on a table within reach, two centimetres and five degrees off;
``starting``: the same, but now and then each jumps into a hand for a moment, as if it was used.

``--recordings DIR`` adds tracked recordings (``inhand bench outcomes`` makes them): what is said
when each is taken for one of the other fourteen things.
"""

import argparse
import os
import time
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path

import msgspec
import numpy as np
from inhand_lab.world.idle_people import IDLENESS, simulate_idle
from inhand_lab.world.messages import person_message
from inhand_lab.world.simulation import Simulation
from inhand_outcomes.outcome import Outcome
from inhand_outcomes.room import LEVEL, Room
from inhand_outcomes.thing import Thing
from inhand_outcomes.things import load_things
from inhand_outcomes.watching import Watcher
from inhand_runtime.recording import read_recording
from inhand_schemas.joints import Joint
from inhand_schemas.messages import CameraInfo, ObjectPose, Pose, Skeletons
from inhand_tracker.loading import load_watcher
from inhand_tracker.people.watching import CameraFrame
from inhand_tracker.settings import TrackerSettings
from inhand_tracker.wire.poses import SourceFrame, object_pose_message
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

Array = NDArray[np.float64]

RATE = 30.0
FRAME_NS = round(1e9 / RATE)
SPELL_S = 60
"""Seconds for which somebody is idle in one way."""
BETWEEN_NS = 10_000_000_000
ERROR_M, ERROR_RAD, ALIKE_S = 0.02, np.radians(5.0), 0.3
START_EVERY_S = 20.0
"""Mean time between two false starts of one thing."""
SURE = 0.5
SUFFIX = "_retrack"


def main() -> None:
    """Say what the command line asks for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("models", type=Path, help="folder of models of the fifteen things")
    parser.add_argument("--hours", type=float, default=1.0, help="of lying, and of starting (1)")
    parser.add_argument("--seed", type=int, default=6001)
    parser.add_argument("--only", choices=("unseen", "lying", "starting", "recordings"))
    parser.add_argument("--recordings", type=Path)
    chosen = parser.parse_args()
    models = sorted(chosen.models.glob("*.model"))
    things, problems = load_things(models, {})
    assert not problems, problems
    wanted = {
        "unseen": lambda: _watch_unseen(things, models, chosen.seed),
        "lying": lambda: _watch(things, chosen.hours, chosen.seed, starts=False),
        "starting": lambda: _watch(things, chosen.hours, chosen.seed, starts=True),
        "recordings": lambda: _watch_recordings(things, chosen.recordings),
    }
    for name, watch in wanted.items():
        if chosen.only in (None, name) and (name != "recordings" or chosen.recordings):
            print(f"{name}:")
            watch()
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")


def _idle(hours: float, seed: int) -> Iterator[tuple[int, Simulation]]:
    """People who are idle in turns, with the capture time at which each begins."""
    spells = max(round(hours * 3600 / SPELL_S), 1)
    for number in range(spells):
        idleness = IDLENESS[number % len(IDLENESS)]
        person = simulate_idle(idleness, number // len(IDLENESS), seed, round(SPELL_S * RATE), RATE)
        yield number * (SPELL_S * 10**9 + BETWEEN_NS), person


def _skeletons(person: Simulation, frame: int, start_ns: int) -> Skeletons:
    return Skeletons(
        sequence=frame, time_ns=start_ns + frame * FRAME_NS, people=(person_message(person, frame),)
    )


def _watch_unseen(things: Mapping[str, Thing], models: list[Path], seed: int) -> None:
    watcher, said = Watcher(things, "idle"), []
    settings = TrackerSettings(camera="camera", models=tuple(map(str, models)))
    tracker = load_watcher("idle", settings)
    states: Counter[str] = Counter()
    start_ns, person = next(_idle(1.0, seed))
    watcher.room = room_of(person)
    for frame in range(person.frames):
        skeletons = _skeletons(person, frame, start_ns)
        joints = person.joints_in_camera[frame].copy()
        joints[person.joint_states[frame] == 0] = np.nan
        said += watcher.hear_skeletons("camera", skeletons)
        for one in tracker.see(joints, CameraFrame(skeletons.time_ns), _fail):
            states[one.estimate.state] += 1
            source = SourceFrame(frame, skeletons.time_ns, "camera")
            message = object_pose_message(one.estimate, source, name=one.name, person=0)
            said += watcher.hear_pose(message)
    _report(said + watcher.end_all(), person.frames / RATE)
    print(f"  states of poses: {dict(states)}")


def _fail(name: str, error: Exception) -> None:
    raise AssertionError(name) from error


def _watch(things: Mapping[str, Thing], hours: float, seed: int, *, starts: bool) -> None:
    watcher, said, spent_s, seconds = Watcher(things, "idle"), [], 0.0, 0.0
    random = np.random.default_rng([seed, int(starts)])
    for start_ns, person in _idle(hours, seed):
        watcher.room = room_of(person)
        told = [list(_poses(name, person, start_ns, random, starts=starts)) for name in things]
        heard = [_skeletons(person, frame, start_ns) for frame in range(person.frames)]
        before = time.process_time()
        for skeletons, *poses in zip(heard, *told, strict=True):
            said += watcher.hear_skeletons("camera", skeletons)
            for pose in poses:
                said += watcher.hear_pose(pose)
        spent_s += time.process_time() - before
        seconds += person.frames / RATE
    _report(said + watcher.end_all(), seconds)
    print(f"  {spent_s / seconds:.3f} of a core for {len(things)} things at {RATE:.0f} Hz")


def room_of(person: Simulation) -> Room:
    """Where up and the floor truly are."""
    up = person.camera_from_world.rotation[:, 2]
    return Room(up, float(up @ person.camera_from_world.translation))


def _poses(
    name: str, person: Simulation, start_ns: int, random: np.random.Generator, *, starts: bool
) -> Iterator[ObjectPose]:
    """What a tracker says of a thing that stands or lies on a table, and of none in hands."""
    frames = person.frames
    turn = Rotation.from_euler("z", random.uniform(0.0, 2.0 * np.pi))
    if random.uniform() < 0.5:
        turn = Rotation.random(random_state=random)
    place = [random.uniform(-0.6, 0.6), random.uniform(0.25, 0.55), random.uniform(0.7, 0.8)]
    camera = person.camera_from_world
    places = np.tile(camera.rotation @ place + camera.translation, (frames, 1))
    turns = np.tile((Rotation.from_matrix(camera.rotation) * turn).as_quat(), (frames, 1))
    confidences = random.uniform(0.5, 0.95) * np.ones(frames)
    if starts:
        for first, last in _false_starts(frames, random):
            hand = random.choice([Joint.HAND_LEFT, Joint.HAND_RIGHT])
            offset = random.normal(0.0, 0.03, 3)
            places[first:last] = person.joints_in_camera[first:last, hand] + offset
            turns[first:last] = Rotation.random(random_state=random).as_quat()
            confidences[first:last] = random.uniform(0.3, 0.9)
    places = places + ERROR_M * _alike(frames, random)
    erring = Rotation.from_rotvec(ERROR_RAD * _alike(frames, random)) * Rotation.from_quat(turns)
    rotations = erring.as_quat(scalar_first=True)
    covariance = tuple(np.diag([ERROR_M**2] * 3 + [ERROR_RAD**2] * 3).ravel().tolist())
    for frame in range(frames):
        yield ObjectPose(
            sequence=frame,
            time_ns=start_ns + frame * FRAME_NS,
            object=name,
            camera="camera",
            state="tracked",
            confidence=float(confidences[frame]),
            person=0,
            camera_from_object=Pose(
                tuple(places[frame].tolist()), tuple(rotations[frame].tolist())
            ),
            covariance=covariance,
        )


def _false_starts(frames: int, random: np.random.Generator) -> Iterator[tuple[int, int]]:
    """First and last frame of each moment for which a thing is thought to be in a hand."""
    at = random.exponential(START_EVERY_S)
    while at * RATE < frames:
        end = at + random.uniform(0.3, 2.0)
        yield round(at * RATE), round(end * RATE)
        at = end + random.exponential(START_EVERY_S)


def _alike(frames: int, random: np.random.Generator) -> Array:
    """Errors (T, 3) of deviation 1 that are alike for a while."""
    kept = np.exp(-1.0 / (ALIKE_S * RATE))
    fresh = random.standard_normal((frames, 3)) * np.sqrt(1.0 - kept**2)
    errors = np.empty((frames, 3))
    errors[0] = random.standard_normal(3)
    for frame in range(1, frames):
        errors[frame] = kept * errors[frame - 1] + fresh[frame]
    return errors


def _watch_recordings(things: Mapping[str, Thing], folder: Path) -> None:
    """Take what each tracked thing does for what each other thing does."""
    for path in sorted(folder.glob("*.mcap")):
        streams = ("info", "skeletons", "pose")
        messages = [(one.name, one.message()) for one in read_recording(path, streams=streams)]
        poses = [one for _, one in messages if isinstance(one, ObjectPose)]
        true = next(one.object for one in poses if one.object.endswith(SUFFIX))
        said: Counter[str] = Counter()
        for thing in things.values():
            if thing.name != true.removesuffix(SUFFIX):
                for one in _taken_for(thing, true, messages):
                    said[f"{thing.name} {one.kind}"] += 1
        print(f"  {path.stem:18} {dict(said.most_common())}")


HANDLED = ("taken_up", "put_down", "dropped", "left_in_use", "handed_over")


def _taken_for(
    thing: Thing, true: str, messages: list[tuple[str, CameraInfo | Skeletons | ObjectPose]]
) -> Iterator[Outcome]:
    """What of a thing's use is said where it stands for another; that that was handled is true."""
    watcher, said = Watcher({thing.name: thing}, "wrong"), []
    watcher.room = LEVEL
    for name, message in messages:
        if isinstance(message, CameraInfo):
            watcher.hear_info(name, message)
        elif isinstance(message, Skeletons):
            said += watcher.hear_skeletons(name, message)
        elif message.object == true:
            said += watcher.hear_pose(msgspec.structs.replace(message, object=thing.name))
    for one in said + watcher.end_all():
        if one.probability >= SURE and one.kind not in HANDLED:
            yield one


def _report(said: list[Outcome], seconds: float) -> None:
    sure = [one for one in said if one.probability >= SURE]
    print(f"  {len(sure)} events in {seconds / 3600.0:.2f} h")
    for (name, kind), times in Counter((one.object, one.kind) for one in sure).most_common():
        print(f"  {name:15} {kind:12} {times:4}   {times * 24.0 * 3600.0 / seconds:8.1f} in 24 h")


if __name__ == "__main__":
    main()

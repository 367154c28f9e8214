"""Publishes somebody who carries a cup, as a camera and a tracker would: ``carrying_publisher.py``.

Frames from ``--from`` to ``--until``, seconds, are sent ``--speed`` times as fast as they were
captured, again and again ``--times``, each ten seconds later. With ``--without-recogniser`` poses
say nothing of whether the cup is in use.
"""

import argparse
import sys
import time

import msgspec
from carried_cup import START_NS, Carrying
from inhand_runtime.session import Publisher, open_session
from inhand_runtime.settings import ZenohSettings
from inhand_schemas.keys import Site
from inhand_schemas.messages import ObjectPose, Skeletons
from inhand_schemas.topics import POSE, RELIABLE, SKELETONS, Topic

ROUND_NS = 10 * 10**9
# Waiting for the readers, so that a busy machine slows a test and loses it nothing.
PEOPLE = Topic(SKELETONS.stream, Skeletons, RELIABLE)
POSES = Topic(POSE.stream, ObjectPose, RELIABLE)


def main() -> int:
    """Publish all frames as soon as somebody listens."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--meeting", required=True)
    parser.add_argument("--start-ns", type=int, default=START_NS)
    parser.add_argument("--from", dest="first", type=float, default=0.0)
    parser.add_argument("--until", type=float, default=9.0)
    parser.add_argument("--times", type=int, default=1)
    parser.add_argument("--speed", type=float, default=3.0)
    parser.add_argument("--without-recogniser", action="store_true")
    chosen = parser.parse_args()
    with open_session(ZenohSettings(meeting=chosen.meeting)) as session:

        def ignore(_key: str) -> None: ...

        people = Publisher(session, PEOPLE, PEOPLE.key(Site(), "front"), ignore)
        poses = Publisher(session, POSES, POSES.key(Site(), "cup"), ignore)
        print("ready", flush=True)
        while not (people.wanted() and poses.wanted()):
            time.sleep(0.02)
        for number in range(chosen.times):
            start_ns = chosen.start_ns + number * ROUND_NS
            began = time.monotonic()
            for skeletons, pose in Carrying(start_ns=start_ns).messages(chosen.until):
                second = (pose.time_ns - start_ns) * 1e-9
                if second < chosen.first:
                    continue
                ahead_s = (second - chosen.first) / chosen.speed - (time.monotonic() - began)
                time.sleep(max(ahead_s, 0.0))
                if chosen.without_recogniser:
                    pose = msgspec.structs.replace(pose, class_probabilities={})
                people.put(skeletons)
                poses.put(pose)
        print("done", flush=True)
        time.sleep(1.0)  # so that what waits in the session's queues goes out
    return 0


if __name__ == "__main__":
    sys.exit(main())

"""A daemon that prints the skeletons it receives; with ``stuck`` it never looks at its stop."""

import sys
import time

from inhand_runtime.daemon import running_daemon
from inhand_runtime.entry import daemon_main
from inhand_runtime.settings import Section, Settings
from inhand_schemas.topics import SKELETONS


class SmallSettings(Section):
    """``[tracker.NAME]`` of this test's daemon."""

    stuck: bool = False


def run(settings: Settings[SmallSettings]) -> None:
    """Print until told to stop."""
    with running_daemon("tracker", settings) as daemon:
        daemon.subscribe(SKELETONS)
        daemon.health.state = "running"
        while settings.service.stuck or not daemon.stop.is_set():
            sample = daemon.receive(0.1)
            if settings.service.stuck and daemon.stop.is_set():
                print("does not care", flush=True)
                time.sleep(60)
            if sample is not None and (skeletons := daemon.decode(SKELETONS, sample)):
                print(f"got {skeletons.sequence}", flush=True)


if __name__ == "__main__":
    sys.exit(daemon_main("tracker", SmallSettings, run))

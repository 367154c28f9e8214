"""What of a host a fault changes, in processes of their own."""

import subprocess
import sys
import time
from pathlib import Path

import pytest
from inhand_lab.chaos.host import new_host
from inhand_lab.chaos.pluggable import PluggableSource
from inhand_runtime.source import SourceAbsentError, SourceLostError

READS = """
import sys, time
for _ in sys.stdin:
    print(time.time_ns(), time.time(), flush=True)
"""


def test_a_process_of_the_host_reads_its_clock_as_it_was_set(tmp_path: Path) -> None:
    host = new_host(tmp_path / "host")
    with subprocess.Popen(
        [sys.executable, "-c", READS],
        env=host.environment,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        bufsize=1,
    ) as process:
        assert process.stdin is not None
        assert process.stdout is not None

        def reads_less_s() -> tuple[float, float]:
            process.stdin.write("now\n")
            nanoseconds, seconds = process.stdout.readline().split()
            now = time.time()
            return now - int(nanoseconds) / 1e9, now - float(seconds)

        assert reads_less_s() == pytest.approx((0.0, 0.0), abs=60.0)
        host.clock.step(3600.0)
        assert reads_less_s() == pytest.approx((-3600.0, -3600.0), abs=60.0)
        host.clock.step(-7200.0)
        assert reads_less_s() == pytest.approx((3600.0, 3600.0), abs=60.0)


def test_a_camera_is_lost_when_it_is_unplugged_and_absent_until_it_is_back(tmp_path: Path) -> None:
    plug = tmp_path / "plug"
    options = {"plug": str(plug), "frames": 8}
    with pytest.raises(SourceAbsentError):
        PluggableSource(options)
    plug.touch()
    captures = PluggableSource(options).captures(lambda: False)
    next(captures)
    plug.unlink()
    with pytest.raises(SourceLostError):
        next(captures)

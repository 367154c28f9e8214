"""What depthai is kept from when it is imported."""

import json
import os
import subprocess
import sys

import pytest

IMPORT = """
import json, os
from inhand_capture.sources.oak.library import dai
pipeline = dai.Pipeline(createImplicitDevice=False)
print(json.dumps({name: value for name, value in os.environ.items() if "DEPTHAI" in name}))
"""


@pytest.mark.long
def test_telemetry_crash_dumps_and_recordings_are_off_whatever_the_environment_says() -> None:
    wishes = {"DEPTHAI_TELEMETRY": "1", "DEPTHAI_CRASHDUMP": "/tmp", "DEPTHAI_RECORD": "/tmp"}
    done = subprocess.run(
        [sys.executable, "-c", IMPORT],
        env=os.environ | wishes,
        capture_output=True,
        text=True,
        check=True,
    )
    settled = json.loads(done.stdout.splitlines()[-1])
    assert settled["DEPTHAI_TELEMETRY"] == settled["DEPTHAI_CRASHDUMP"] == "0"
    assert "DEPTHAI_RECORD" not in settled

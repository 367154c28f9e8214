"""depthai, imported so that it reports nothing to its makers and stores no picture.

By itself it sends an event for its import, for each node and graph, and for the end of a run; it
collects crash dumps, which hold the device's memory; and it records all frames where the
environment says so, before any mask. The environment settles all three; it is read at the import.
"""

import os

os.environ["DEPTHAI_TELEMETRY"] = "0"
os.environ["DEPTHAI_CRASHDUMP"] = "0"
os.environ["DEPTHAI_DISABLE_CRASHDUMP_COLLECTION"] = "1"
# Nor does it look into the network for models, unless somebody wants it.
os.environ.setdefault("DEPTHAI_ZOO_INTERNET_CHECK", "0")
for recording in ("DEPTHAI_RECORD", "DEPTHAI_REPLAY"):
    os.environ.pop(recording, None)
# What it warns of at its import and at each look for devices is said by health, once.
os.environ.setdefault("DEPTHAI_LEVEL", "error")

import depthai as dai  # noqa: E402

__all__ = ["dai"]

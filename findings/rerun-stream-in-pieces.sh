#!/usr/bin/env bash
# rerun-sdk 0.41.0 (Python 3.11, Linux): a recording that was read in pieces is no valid one.
#
# Expected: `BinaryStream.read` gives the bytes that came since the last call, so that a program that
# writes what it reads, as it comes, has the same file in the end as one that reads all at once.
# Seen: each piece ends with a table of contents of its own. The file of all pieces is refused by
# `rerun rrd verify`, of the same release: it has more than one table, and one cannot be decoded. Read
# in one call after all was logged, the same messages are a valid file.
#
# Output seen:
#   read at once: verified
#   read in 20 pieces: refused
#   "pieces.rrd"/check/a: More than one RRD manifest
#   Error: Verification failed with 2 errors
#
# The script ends with 0 while that is so, and with 1 when it has changed.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export HOME="$work"  # Rerun keeps its own settings there
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check rerun-sdk==0.41.0
cat > "$work/stream.py" <<'PYTHON'
import sys

import rerun

recording = rerun.RecordingStream("check", recording_id="a")
stream = recording.binary_stream()
with open(sys.argv[1], "wb") as file:
    for number in range(20):
        recording.set_time("frame", sequence=number)
        recording.log("points", rerun.Points3D([[0.0, 0.0, float(number)]] * 100))
        if sys.argv[2] == "pieces":
            file.write(stream.read() or b"")
    file.write(stream.read() or b"")
PYTHON
cd "$work"
"$work/venv/bin/python" stream.py once.rrd once 2> /dev/null
"$work/venv/bin/python" stream.py pieces.rrd pieces 2> /dev/null
verify() { "$work/venv/bin/rerun" rrd verify "$1" > "$1.txt" 2>&1; }
verify once.rrd && echo "read at once: verified" || { cat once.rrd.txt; exit 1; }
if verify pieces.rrd; then
    echo "read in 20 pieces: verified: this has changed"
    exit 1
fi
echo "read in 20 pieces: refused"
grep -E "More than one RRD manifest|Verification failed" pieces.rrd.txt

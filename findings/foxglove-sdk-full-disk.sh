#!/usr/bin/env bash
# foxglove-sdk 0.30.3 (Python 3.11 and newer, Linux): a full disk raises nothing while it is recorded.
#
# Expected: an OSError that `write` of the file given to open_mcap raises comes out of the `log` that
# was writing, or of the next one, as from any writer in Python.
# Seen: every `log` returns as if it had written; the OSError is printed on standard error alone, and
# of what comes after nothing is written. `close` raises a RuntimeError that names no cause, and a
# second `close` raises nothing. A recorder learns of a full disk when it ends.
#
# Output seen:
#   messages logged: 100, exceptions: 0
#   OSError raised by the file: 1
#   first close: RuntimeError: FoxgloveError: MCAP error: attempted another write after a write method failed
#   second close: nothing
#
# The script ends with 0 while that is so, and with 1 when it has changed.
set -euo pipefail
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
python3 -m venv "$work/venv"
"$work/venv/bin/pip" install --quiet --disable-pip-version-check foxglove-sdk==0.30.3
cat > "$work/full.py" <<'PYTHON'
import errno
import os
import sys

import foxglove

ROOM = 2_000_000


class FullDisk:
    """A file on a disk with room for ROOM bytes."""

    def __init__(self, path):
        self.file = open(path, "wb")
        self.raised = 0

    def write(self, data):
        if self.file.tell() + len(data) > ROOM:
            self.raised += 1
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return self.file.write(data)

    def seek(self, *where):
        return self.file.seek(*where)

    def flush(self):
        self.file.flush()


def outcome(action):
    try:
        action()
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    return "nothing"


disk = FullDisk(sys.argv[1])
writer = foxglove.open_mcap(disk)
schema = foxglove.Schema(name="Bytes", encoding="", data=b"")
channel = foxglove.Channel("/bytes", message_encoding="bytes", schema=schema)
outcomes = [outcome(lambda: channel.log(os.urandom(100_000))) for _ in range(100)]
print(f"messages logged: {len(outcomes)}, exceptions: {len(outcomes) - outcomes.count('nothing')}")
print(f"OSError raised by the file: {disk.raised}")
print(f"first close: {outcome(writer.close)}")
print(f"second close: {outcome(writer.close)}")
PYTHON
"$work/venv/bin/python" "$work/full.py" "$work/full.mcap" 2> "$work/errors" | tee "$work/seen"
cat > "$work/expected" <<'TEXT'
messages logged: 100, exceptions: 0
OSError raised by the file: 1
first close: RuntimeError: FoxgloveError: MCAP error: attempted another write after a write method failed
second close: nothing
TEXT
diff "$work/expected" "$work/seen"
grep -q 'No space left on device' "$work/errors"

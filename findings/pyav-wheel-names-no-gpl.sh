#!/usr/bin/env bash
# av 18.1.0 (PyAV): its wheel holds libx264 and libx265, which are under the GPL, and nothing in it
# says so.
#
# One would bet that FFmpeg, built with libx264, calls itself GPL: its own configure refuses x264
# without --enable-gpl. The wheel's libavcodec encodes with libx264, but its licence reads LGPL, its
# configure line has no --enable-gpl, and the package's metadata names BSD-3-Clause alone. Who ships a
# program with this wheel ships x264, and learns of its licence from file names.
#
# Output seen on 2026-11-30:
#   license of the package: BSD-3-Clause
#   license of libavcodec: LGPL version 3 or later
#   --enable-gpl: False; encodes with libx264: True
#   beside it: libx264, libx265
#
# The script ends with 0 while that is so, and with 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check av==18.1.0
"$folder/venv/bin/python" - <<'PYTHON'
import importlib.metadata
import pathlib
import sys

import av
import av._core

metadata = importlib.metadata.metadata("av")
package = metadata["License-Expression"] or metadata["License"]
codecs = av._core.library_meta["libavcodec"]
gpl = "--enable-gpl" in codecs["configuration"]
encodes = av.CodecContext.create("libx264", "w").name == "libx264"
libraries = pathlib.Path(av.__file__).parent.parent / "av.libs"
beside = sorted({path.name.split("-")[0] for path in libraries.iterdir() if "libx26" in path.name})
print("license of the package:", package)
print("license of libavcodec:", codecs["license"])
print(f"--enable-gpl: {gpl}; encodes with libx264: {encodes}")
print("beside it:", ", ".join(beside))
same = (package, codecs["license"][:4], gpl, encodes, beside)
sys.exit(same != ("BSD-3-Clause", "LGPL", False, True, ["libx264", "libx265"]))
PYTHON

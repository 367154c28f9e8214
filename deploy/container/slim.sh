#!/bin/sh
# Takes out of a virtual environment what Python packages bring and nothing of ours opens; for an image, so pip goes too.
#   slim.sh /opt/inhand
set -eu
python=$1/bin/python3
packages=$("$python" -c 'import sysconfig; print(sysconfig.get_path("platlib"))')
ours=$("$python" -c 'import sysconfig; print(sysconfig.get_config_var("EXT_SUFFIX"))')

"$python" -m pip uninstall --quiet --yes setuptools pip
# Modules for other versions of Python: depthai brings seven, of 16 MB each.
find "$packages" -name '*.cpython-*.so' ! -name "*$ours" -delete
# The libraries' own tests. What is called "testing" stays: SciPy imports NumPy's.
find "$packages" -depth -type d -name tests -exec rm -r {} +
# Skeletons are estimated on the processor.
find "$packages" -name 'libLiteRtWebGpuAccelerator.so' -delete
# Symbols for a debugger, in the packages where they are many. Not in all: libraries that were given other
# dependencies when their wheel was made cannot be read after strip (numba's omppool is one).
for package in llvmlite lz4 msgpack zenoh zstandard; do
    find "$packages/$package" -name '*.so' -exec strip --strip-unneeded {} +
done
"$python" -c 'import llvmlite.binding, lz4.block, lz4.frame, msgpack, zenoh, zstandard'

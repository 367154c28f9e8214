#!/usr/bin/env bash
# opencv-python-headless 5.0.0.93: solvePnPRefineLM gives back what is not refined, by the shape.
#
# Corners of a board are projected exactly, and a pose that is 10 mm and 0.01 rad off in each direction
# is refined on them. With a rotation vector and a translation of shape (3, 1) the pose fits to
# 0.00001 pixels. With shape (3,), which the function takes and returns without a word, the
# one that has it comes back as it was given: no error, and a pose that is pixels off, or, where only
# one of the two has it, one half of a refined pose beside the other half of the start.
#
# So a board's poses are refined from columns here.
#
# Output seen on 2026-11-30:
#   turn (3, 1) refined, shift (3, 1) refined: 0.0 pixels off
#   turn (3, 1) refined, shift (3,) as given: 7.2 pixels off
#   turn (3,) as given, shift (3, 1) refined: 1.2 pixels off
#   turn (3,) as given, shift (3,) as given: 8.1 pixels off
#
# The script ends with 0 while that is so, and with 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check opencv-python-headless==5.0.0.93 numpy==2.4.6
cat > "$folder/refine.py" <<'PYTHON'
import cv2
import numpy as np

across, down = np.meshgrid(np.arange(5) * 0.04, np.arange(4) * 0.04)
corners = np.stack((across.ravel(), down.ravel(), np.zeros(20)), axis=1)
camera = np.array([[600.0, 0, 320], [0, 600, 240], [0, 0, 1]])
turn, shift = np.array([0.3, -0.2, 0.1]), np.array([0.05, 0.02, 0.8])
seen = cv2.projectPoints(corners, turn, shift, camera, None)[0]
refined = []
for turn_shape in ((3, 1), (3,)):
    for shift_shape in ((3, 1), (3,)):
        start = (turn + 0.01).reshape(turn_shape), (shift + 0.01).reshape(shift_shape)
        given = cv2.solvePnPRefineLM(corners, seen, camera, None, *(one.copy() for one in start))
        kept = [bool(np.array_equal(one, other)) for one, other in zip(start, given)]
        off = np.abs(cv2.projectPoints(corners, *given, camera, None)[0] - seen).max()
        words = ["as given" if one else "refined" for one in kept]
        print(f"turn {turn_shape} {words[0]}, shift {shift_shape} {words[1]}: {off:.1f} pixels off")
        refined.append(kept)
raise SystemExit(refined != [[False, False], [False, True], [True, False], [True, True]])
PYTHON
"$folder/venv/bin/python" "$folder/refine.py"

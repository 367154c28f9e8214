#!/usr/bin/env bash
# viser 1.1.1: a colour given to line segments one by one is shown lighter than the same one given for all.
#
# One would bet that add_line_segments shows a colour as it is, whether it is a tuple for all segments or
# an array with a colour for each end. Colours one by one come out much lighter, about as if they had been
# linear and were put on the sRGB curve: dark ones are pale, and differences among bright ones are hard to
# see. What tells lines apart by weight has to begin with colours that are nearly black.
#
# Needs Chromium on the PATH. Output seen on 2026-11-29 is below; the script ends with 0 while the one is
# near what was asked for and the other is not, and with 1 when that has changed.
#   asked for: 60 70 140; as one tuple: 44 60 149; one by one: 150 159 200
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    viser==1.1.1 playwright==1.65.2 opencv-python-headless==4.10.0.84
cat > "$folder/look.py" <<'PYTHON'
import shutil
import time

import cv2
import numpy as np
import viser
from playwright.sync_api import sync_playwright

ASKED = np.array([60, 70, 140])
ENDS = np.array([[[-3.0, 0.0, 0.0], [3.0, 0.0, 0.0]]])

server = viser.ViserServer("127.0.0.1", 0, verbose=False)


@server.on_client_connect
def look(client: viser.ClientHandle) -> None:
    client.camera.position = (0.0, 0.0, 4.0)
    client.camera.look_at = (0.0, 0.0, 0.0)


def shown(page: object) -> np.ndarray:
    """The colour that most of the pixels have which are neither white nor the panel's."""
    time.sleep(3.0)
    seen = cv2.imdecode(np.frombuffer(page.screenshot(), np.uint8), cv2.IMREAD_COLOR)
    pixels = seen[200:, 300:700, ::-1].reshape(-1, 3)
    pixels = pixels[pixels.sum(axis=1) < 700]
    colours, counts = np.unique(pixels, axis=0, return_counts=True)
    return colours[np.argmax(counts)].astype(int)


def add(name: str, colours: object) -> viser.LineSegmentsHandle:
    return server.scene.add_line_segments(
        name, ENDS, colours, thickness=60.0, thickness_units="screen"
    )


with sync_playwright() as playwright:
    browser = playwright.chromium.launch(
        executable_path=shutil.which("chromium"),
        args=["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
              "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
    )
    page = browser.new_page(viewport={"width": 1000, "height": 700})
    page.goto(f"http://127.0.0.1:{server.get_port()}")
    time.sleep(5.0)
    line = add("/first", tuple(ASKED.tolist()))
    for_all = shown(page)
    line.remove()
    add("/second", np.tile(ASKED.astype(np.uint8), (1, 2, 1)))
    one_by_one = shown(page)
    browser.close()
server.stop()
print("asked for:", *ASKED, end="; as one tuple: ")
print(*for_all, end="; one by one: ")
print(*one_by_one)
assert np.abs(for_all - ASKED).max() < 25
assert (one_by_one - ASKED).min() > 30
PYTHON
"$folder/venv/bin/python" "$folder/look.py" | tail -1

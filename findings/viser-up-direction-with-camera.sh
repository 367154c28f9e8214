#!/usr/bin/env bash
# viser 1.1.1: a camera that is set in one go with the scene's up direction looks elsewhere.
#
# A page sets the up direction, and then the camera's place and what it looks at, as soon as a browser
# connects. One would bet that the browser looks there: the messages are sent in that order. It looks
# along the up direction of before instead: the camera is placed by the scene's old orientation, for
# the new one is taken over only when the page is drawn next. The same two calls again, seconds later,
# are obeyed. So set the up direction once, before anybody connects.
#
# Needs Chromium on the PATH. Output seen on 2026-11-28:
#   asked to look along [0. 0. 1.], looks along [ 0. -1.  0.]
#   asked again later, looks along [0. 0. 1.]
#
# The script ends with 0 while that is so, and with 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check viser==1.1.1 playwright==1.65.2
cat > "$folder/look.py" <<'PYTHON'
import shutil
import threading
import time

import numpy as np
import viser
from playwright.sync_api import sync_playwright

server = viser.ViserServer("127.0.0.1", 0, verbose=False)
looks: list[np.ndarray] = []
seen = threading.Event()


def look_along(client: viser.ClientHandle) -> None:
    client.camera.position = (0.0, 0.0, 0.0)
    client.camera.up_direction = (0.0, -1.0, 0.0)
    client.camera.look_at = (0.0, 0.0, 2.0)


def looked(client: viser.ClientHandle) -> np.ndarray:
    time.sleep(3.0)
    forward = client.camera.look_at - client.camera.position
    return np.round(forward / np.linalg.norm(forward), 3) + 0.0


@server.on_client_connect
def _(client: viser.ClientHandle) -> None:
    client.scene.set_up_direction((0.0, -1.0, 0.0))
    look_along(client)
    looks.append(looked(client))
    client.camera.look_at = (0.0, 0.1, 2.0)
    look_along(client)
    looks.append(looked(client))
    seen.set()


with sync_playwright() as playwright:
    browser = playwright.chromium.launch(
        executable_path=shutil.which("chromium"),
        args=["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
              "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
    )
    browser.new_page().goto(f"http://127.0.0.1:{server.get_port()}")
    assert seen.wait(60.0)
    browser.close()
server.stop()
print("asked to look along [0. 0. 1.], looks along", looks[0])
print("asked again later, looks along", looks[1])
assert not np.allclose(looks[0], [0.0, 0.0, 1.0], atol=0.05)
assert np.allclose(looks[1], [0.0, 0.0, 1.0], atol=0.05)
PYTHON
"$folder/venv/bin/python" "$folder/look.py" | tail -2

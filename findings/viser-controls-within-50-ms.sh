#!/usr/bin/env bash
# viser 1.1.1: of controls that are used within 50 ms the server hears of the first and the last alone.
#
# One would bet that each press of a button reaches the server, however soon the next one comes, and
# that at the most a slider's many values are thinned out. The browser thins out what all controls of a
# panel send together: it sends one message, waits 50 ms, and then sends the newest; what came between is
# lost, also where it is another button's. Who drives a page by a program, or fills in a form by one,
# has to wait more than 50 ms after each control.
#
# Needs Chromium on the PATH. Output seen on 2026-11-29:
#   pressed within one turn of the browser: one two three four; heard: one four
#   pressed 200 ms apart: one two three four; heard: one two three four
#
# The script ends with 0 while that is so, and with 1 when it has changed.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check viser==1.1.1 playwright==1.65.2
cat > "$folder/press.py" <<'PYTHON'
import shutil
import time

import viser
from playwright.sync_api import sync_playwright

NAMES = ["one", "two", "three", "four"]
PRESS_ALL = """names => {
    const buttons = [...document.querySelectorAll("button")];
    for (const name of names) buttons.find(b => b.textContent.trim() === name).click();
}"""

heard: list[str] = []
server = viser.ViserServer("127.0.0.1", 0, verbose=False)
for name in NAMES:
    # Async callbacks run in the order in which messages arrive.
    async def press(_event: object, name: str = name) -> None:
        heard.append(name)

    server.gui.add_button(name).on_click(press)

with sync_playwright() as playwright:
    browser = playwright.chromium.launch(
        executable_path=shutil.which("chromium"),
        args=["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
              "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"],
    )
    page = browser.new_page()
    page.goto(f"http://127.0.0.1:{server.get_port()}")
    page.get_by_role("button", name="four").wait_for()
    time.sleep(2.0)
    page.evaluate(PRESS_ALL, NAMES)
    time.sleep(2.0)
    at_once, heard[:] = list(heard), []
    for name in NAMES:
        page.evaluate(PRESS_ALL, [name])
        time.sleep(0.2)
    time.sleep(1.0)
    browser.close()
server.stop()
print("pressed within one turn of the browser:", *NAMES, end="; heard: ")
print(*at_once)
print("pressed 200 ms apart:", *NAMES, end="; heard: ")
print(*heard)
assert at_once == ["one", "four"]
assert heard == NAMES
PYTHON
"$folder/venv/bin/python" "$folder/press.py" | tail -2

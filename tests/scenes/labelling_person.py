"""A person who labels an object on the studio's page, in a real browser."""

import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from browser import SENT_MS
from inhand_studio.labelling_page.placing import to_degrees
from playwright.sync_api import Page
from running_rig import eventually


class LabellingPerson:
    """Does on a tab of the labelling page what a person does with keys, mouse and numbers."""

    def __init__(self, page: Page) -> None:
        self.page = page
        page.get_by_text("Set keyframe", exact=True).wait_for(timeout=60_000)
        eventually("the page", lambda: self.frame >= 0)

    @property
    def status(self) -> str:
        """All that the panel says."""
        return self.page.inner_text("body")

    @property
    def frame(self) -> int:
        """The frame that is shown; -1 before the first."""
        found = re.search(r"Frame (\d+) of", self.status)
        return int(found[1]) if found else -1

    def wait_for(self, text: str, minutes: float = 10.0) -> None:
        """Wait until the panel says something, which may take long on a busy machine."""
        self.page.get_by_text(text).first.wait_for(timeout=60_000 * minutes)

    def leave_controls(self) -> None:
        """Click beside everything, so that keys are no longer for a control."""
        self.page.mouse.click(20, 780)

    def press(self, *keys: str) -> None:
        """Hit keys, one after the other."""
        for key in keys:
            self.page.keyboard.press(key)
            self.page.wait_for_timeout(SENT_MS)

    def click(self, label: str) -> None:
        """Click on a button."""
        self.page.get_by_role("button", name=label, exact=True).click()

    def go(self, frame: int) -> None:
        """Type the number of a frame."""
        field = self._inputs("Frame").last
        field.fill(str(frame))
        field.press("Enter")
        eventually(f"frame {frame}", lambda: self.frame == frame)
        self.leave_controls()

    def type_pose(self, place_m: np.ndarray, rotation: np.ndarray) -> None:
        """Type a pose in the camera's frame, and set it."""
        for label, values in (("Place (cm)", 100.0 * place_m), ("Turns (°)", to_degrees(rotation))):
            fields = self._inputs(label)
            for index, value in enumerate(values):
                fields.nth(index).fill(f"{value:.2f}")
                self.page.wait_for_timeout(SENT_MS)
        fields.nth(2).press("Enter")
        eventually("the keyframe", lambda: re.search(r"s: keyframe", self.status))
        self.leave_controls()

    def fill(self, label: str, text: str) -> None:
        """Write into a field."""
        self._inputs(label).first.fill(text)
        self.page.wait_for_timeout(SENT_MS)

    def choose(self, label: str, option: str) -> None:
        """Choose from a list."""
        self._inputs(label).first.click()
        self.page.get_by_role("option", name=option, exact=True).click()
        self.page.wait_for_timeout(SENT_MS)

    def tick(self, label: str) -> None:
        """Click on a checkbox."""
        self._inputs(label).first.click()
        self.page.wait_for_timeout(SENT_MS)

    def _inputs(self, label: str):  # type: ignore[no-untyped-def]
        row = self.page.locator("label", has_text=re.compile(rf"^{re.escape(label)}$"))
        return row.locator("xpath=ancestor::div[2]").locator("input:not([type=hidden])")


@contextmanager
def labelling(recording: Path, *options: str) -> Iterator[tuple[str, subprocess.Popen[str]]]:
    """Run ``inhand label RECORDING`` while a block runs; gives the page's address and the process,
    which ends by Ctrl-C unless it was killed."""
    command = [sys.executable, "-m", "inhand", "label", str(recording), *options]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            said = process.stdout.readline()
            found = re.search(r"http://\S+/", said)
            assert found is not None, said
            yield found[0], process
        finally:
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
            process.wait(60)

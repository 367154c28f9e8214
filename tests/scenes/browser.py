"""A real Chromium that looks at pages."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

REQUIRED = "CHROMIUM_REQUIRED"
"""Set where a machine without Chromium is a fault, as in CI; INHAND_… would be a setting."""

WINDOW = (1280, 800)
"""Width and height of a tab in pixels."""

SENT_MS = 150
"""Milliseconds until a browser has sent what was typed: of what all controls of a panel send within
50 ms, only the first and the last are sent (findings/viser-controls-within-50-ms.sh)."""

# Software rendering, for a machine without a graphics card or a sandbox for root.
ARGUMENTS = (
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
)


@contextmanager
def chromium() -> Iterator[Browser]:
    """Start Chromium, and end it with the block; the test is skipped where there is none."""
    path = shutil.which("chromium") or shutil.which("chromium-browser")
    if path is None:
        assert REQUIRED not in os.environ, "there is no Chromium: apt-get install chromium"
        pytest.skip("there is no Chromium, which looks at the pages: apt-get install chromium")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=ARGUMENTS)
        yield browser
        browser.close()


@contextmanager
def tab(browser: Browser, url: str, **options: Any) -> Iterator[Page]:
    """Open a page in a context of its own, and close it with the block."""
    context = browser.new_context(viewport={"width": WINDOW[0], "height": WINDOW[1]}, **options)
    # What a page waits for starts processes, which others' tests hold up.
    context.set_default_timeout(60_000)
    page = context.new_page()
    page.goto(url)
    yield page
    context.close()


def fill(page: Page, label: str, text: str) -> None:
    """Write into a control of the panel that stands beside a label."""
    row = page.locator(".mantine-Flex-root", has=page.get_by_text(label, exact=True))
    control = row.locator("input:visible").first
    control.fill(text)
    control.press("Enter")
    page.wait_for_timeout(SENT_MS)


def choose(page: Page, label: str, choice: str) -> None:
    """Choose of the menu of the panel that stands beside a label."""
    row = page.locator(".mantine-Flex-root", has=page.get_by_text(label, exact=True))
    row.locator("input:visible").first.click()
    page.get_by_role("option", name=choice, exact=True).click()
    page.wait_for_timeout(SENT_MS)

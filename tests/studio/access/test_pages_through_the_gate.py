"""viser's own page behind the gate, in Chromium."""

from typing import Any

import pytest
import viser
from browser import chromium, tab
from gated import PASSWORD
from inhand_studio.access.gate import gate
from inhand_studio.access.listening import secluded_address
from inhand_studio.access.settings import AccessSettings
from inhand_studio.server import serving
from playwright.sync_api import expect


class _Shown:
    """A tab with a button, and with a picture of another machine."""

    def __init__(self, client: viser.ClientHandle) -> None:
        self._client = client

    def open(self) -> None:
        """Show them."""
        self._client.gui.add_markdown("![elsewhere](https://elsewhere.example/x.png)")
        text = self._client.gui.add_text("Said", "nothing")

        @self._client.gui.add_button("Speak").on_click
        def _(_event: Any) -> None:
            text.value = "heard"

    def close(self) -> None:
        """Nothing runs."""


@pytest.mark.long
def test_after_the_password_pages_work_and_ask_nothing_of_other_machines() -> None:
    settings = AccessSettings(port=0, password=PASSWORD)  # type: ignore[arg-type]
    inside = secluded_address()
    with (
        serving(inside, 0, _Shown) as port,  # type: ignore[arg-type]
        gate(settings, (inside, port)) as url,
        chromium() as browser,
        tab(browser, url) as page,
    ):
        answered: list[str] = []
        faults: list[str] = []
        page.on("requestfinished", lambda request: answered.append(request.url))
        page.on("pageerror", lambda error: faults.append(str(error)))
        page.get_by_label("Password").fill("not the password")
        page.get_by_role("button", name="Log in").click()
        expect(page.get_by_role("alert")).to_have_text("This is not the password.")
        page.get_by_label("Password").fill(PASSWORD)
        page.get_by_role("button", name="Log in").click()

        page.get_by_role("button", name="Speak").click(timeout=60_000)
        expect(page.locator("input[value=heard]")).to_be_visible()
        expect(page.locator("canvas").first).to_be_attached()
        assert page.get_by_alt_text("elsewhere").evaluate("image => image.naturalWidth") == 0
        assert not faults
        assert url in answered
        assert all(one.startswith((url, f"blob:{url}", "data:")) for one in answered)

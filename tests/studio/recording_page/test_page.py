"""The recording page of a studio, in Chromium."""

import re
import signal
from pathlib import Path

import pytest
from browser import chromium, fill, tab
from inhand_lab.datasets.dataset import load_dataset
from inhand_runtime.errors import InhandError
from inhand_studio.recording_page.wishes import Wishes, record_arguments
from running_rig import RunningRig, eventually

WISHES = Wishes(" Ada B ", True, "drink", None, "front", 5.0, 0.0)


def test_wishes_become_the_arguments_of_the_verb_and_names_are_needed() -> None:
    arguments = record_arguments(WISHES, Path("/data set"), Path("rig.toml"))
    assert arguments == [
        "record",
        "--dataset=/data set",
        "--camera=front",
        "--participant=Ada B",
        "--interaction=drink",
        "--left-handed",
        "--countdown=5",
        "--config=rig.toml",
    ]
    nobody = Wishes(" ", False, "drink", "mug", "front", 5.0, 9.0)
    with pytest.raises(InhandError, match="Participant"):
        record_arguments(nobody, Path(), None)


@pytest.mark.long
def test_a_recording_is_made_in_the_browser_and_kept_where_the_studio_is_killed(
    rig: RunningRig, tmp_path: Path
) -> None:
    dataset = tmp_path / "dataset"
    rig.configure(
        '[capture.front]\nsource = "simulator"\nwait_for_reader_s = 0\n'
        f'[studio.desk]\ndataset = "{dataset}"\nport = 0\n'
    )
    capture = rig.inhand("capture", "--config", rig.config)
    studio = rig.inhand("studio", "--config", rig.config)
    studio.said("the studio is at ")
    url = studio.stderr.split("the studio is at ")[1].split()[0]
    with chromium() as browser, tab(browser, url) as page:
        page.get_by_text("Record", exact=True).click()
        page.get_by_role("button", name="Start recording").click()
        page.get_by_text("write who is recorded (Participant)").wait_for()
        fill(page, "Participant", "Ada")
        fill(page, "Interaction", "drinkFromMug")
        fill(page, "Countdown, s", "1")
        fill(page, "Length, s", "0")
        page.get_by_role("button", name="Start recording").click()
        page.get_by_text("until you stop it").wait_for()
        page.screenshot(path=str(tmp_path / "recording.png"))
        assert "No tracker runs" not in page.inner_text("body")
        page.get_by_role("button", name="Stop recording").click()
        page.get_by_text(re.compile(r"\d+ skeletons?, \d+ lost")).wait_for()
        (entry,) = load_dataset(dataset).entries
        assert (entry.participant, entry.interaction) == ("Ada", "drinkFromMug")

        capture.popen.send_signal(signal.SIGSTOP)
        page.get_by_text("No picture comes").first.wait_for()
        capture.popen.send_signal(signal.SIGCONT)
        page.get_by_text("No picture comes").wait_for(state="detached")
        page.get_by_role("button", name="Start recording").click()
        eventually("a file", lambda: list(dataset.glob("recordings/*.part")))
        assert "Traceback" not in studio.stderr
        studio.stop(signal.SIGKILL)
        eventually("what was recorded", lambda: len(load_dataset(dataset).entries) == 2)
    assert not list(dataset.glob("recordings/*.part"))

"""The training page of a studio, in Chromium."""

from pathlib import Path

import pytest
from browser import chromium, tab
from inhand_tracker.model.model_file import load_model, save_model
from people import wave_model
from running_rig import RunningRig


@pytest.mark.long
def test_a_model_is_trained_measured_and_put_into_the_running_rig(
    rig: RunningRig, tmp_path: Path
) -> None:
    dataset, file = tmp_path / "dataset", tmp_path / "thing.model"
    small = ("--participants", "3", "--frames", "24", "--no-images")
    made = rig.done("simulate", dataset, "--interactions", "drinkFromMug", *small)
    assert made.popen.returncode == 0, made.stderr
    save_model(wave_model(), file)
    rig.configure(
        f'[tracker.thing]\nmodel = "{file}"\n[studio.desk]\ndataset = "{dataset}"\nport = 0\n'
    )
    rig.inhand("tracker", "--config", rig.config).said("tracking wedge")
    studio = rig.inhand("studio", "--config", rig.config)
    studio.said("the studio is at ")
    url = studio.stderr.split("the studio is at ")[1].split()[0]
    with chromium() as browser, tab(browser, url) as page:
        page.set_default_timeout(120_000)
        page.get_by_text("Train", exact=True).click()
        train = page.get_by_role("button", name="Start training")
        train.click()
        page.get_by_role("button", name="Cancel training").click()
        page.get_by_text("cancelled").wait_for()
        assert not (dataset / "models/mug.model").exists()

        train.click()
        page.get_by_text("on a participant who was left out: vertex error").wait_for()
        page.get_by_role("button", name="Put into the running rig").click()
        page.get_by_text("thing follows mug by").wait_for()
    assert load_model(file).shape.name == "mug"
    assert load_model(tmp_path / "thing.model.before").shape.name == "wedge"
    assert studio.stop() == 0
    assert "Traceback" not in studio.stderr

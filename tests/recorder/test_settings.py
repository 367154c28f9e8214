"""A recorder's settings, and what is checked of them before a start."""

from pathlib import Path

import pytest
from inhand_recorder.settings import RecorderSettings, check
from inhand_runtime.errors import SettingsError
from inhand_runtime.settings import Settings, load_settings


def loaded(tmp_path: Path, text: str) -> Settings[RecorderSettings]:
    config = tmp_path / "rig.toml"
    config.write_text(f"[recorder.disk]\n{text}\n")
    return load_settings(config, "recorder", RecorderSettings)


@pytest.mark.parametrize("text", ["", 'folder = "recordings"'])
def test_the_folder_is_beside_the_settings_file_and_checking_makes_nothing(
    tmp_path: Path, text: str
) -> None:
    settings = loaded(tmp_path, text)
    check(settings)
    assert settings.service.folder == tmp_path / "recordings"
    assert not settings.service.folder.exists()


def test_a_folder_that_cannot_be_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SettingsError, match="cannot write to the folder /proc/nowhere: "):
        check(loaded(tmp_path, 'folder = "/proc/nowhere"'))


def test_a_stream_that_is_not_there_is_told_with_what_was_meant(tmp_path: Path) -> None:
    with pytest.raises(SettingsError, match=r"there is no stream 'poses' \(did you mean pose\?\)"):
        loaded(tmp_path, 'streams = ["poses"]')


def test_previews_are_recorded_only_where_somebody_asks(tmp_path: Path) -> None:
    assert "preview" not in loaded(tmp_path, "").service.streams
    asked = loaded(tmp_path, 'streams = ["preview"]').service.streams
    assert asked == ("preview",)


def test_a_pattern_that_excludes_all_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SettingsError, match="nothing would be recorded"):
        loaded(tmp_path, 'streams = ["pose/mug"]\nexclude = ["po*"]')


def test_nothing_is_excluded_without_a_word(tmp_path: Path) -> None:
    assert loaded(tmp_path, "").service.exclude == ()


def test_events_make_clips_only_of_a_ring_and_where_they_are_recorded(tmp_path: Path) -> None:
    with pytest.raises(SettingsError, match="ring_events needs ring_seconds"):
        loaded(tmp_path, 'ring_events = ["fall"]')
    with pytest.raises(SettingsError, match="ring_events needs the stream event"):
        loaded(tmp_path, 'ring_seconds = 5\nring_events = ["fall"]\nexclude = ["event"]')
    with pytest.raises(SettingsError, match=r"did you mean fall\?"):
        loaded(tmp_path, 'ring_seconds = 5\nring_events = ["Fall"]')


def test_quotas_that_cannot_be_are_refused(tmp_path: Path) -> None:
    with pytest.raises(SettingsError, match="needs free_bytes, how much of the disk stays free"):
        loaded(tmp_path, 'when_full = "delete-oldest"')
    with pytest.raises(SettingsError, match="4 MiB must be kept at least"):
        loaded(tmp_path, 'keep_bytes = "1 MiB"')

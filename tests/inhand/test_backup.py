"""A site that was backed up and restored starts as before, or nothing of it is restored."""

import io
import json
import shutil
import tarfile
from collections.abc import Callable, Iterator
from hashlib import sha256
from pathlib import Path
from typing import Any

import pytest
from hub_site import REALM, RIG, HubSite, free_address, made_site
from inhand_outcomes.store.models import OutcomeRow
from inhand_outcomes.store.queries import latest
from inhand_outcomes.store.saving import Saver
from inhand_schemas.keys import Site
from inhand_schemas.topics import POSE
from kept_outcomes import S, at, new_saver, sip
from running_rig import ROOT, RunningRig, eventually
from sqlalchemy import delete

from inhand.__main__ import main

MODEL = ROOT / "tests/tracker/golden/drinkFromMug.model"
SIMULATED = '[capture.front]\nsource = "simulator"\n'
SIMULATED += 'options = { interaction = "drinkFromMug", loop = true }\n'


def _tree(folder: Path) -> dict[str, tuple[str, bytes]]:
    """Every file below a folder, and folder, by its path: with its mode and content."""
    return {
        path.relative_to(folder).as_posix(): (
            oct(path.stat().st_mode)[-3:],
            path.read_bytes() if path.is_file() else b"",
        )
        for path in folder.rglob("*")
    }


def _small_site(folder: Path, **files: str) -> Path:
    """A studio's settings with a password in a file, and objects; returns the settings."""
    folder.mkdir()
    for name, text in {"rig.toml": '[studio.desk]\npassword_file = "secret/word"', **files}.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text)
    (folder / "secret").mkdir()
    (folder / "secret/word").write_text("a password")
    (folder / "secret/word").chmod(0o600)
    (folder / "dataset/objects/mug").mkdir(parents=True)
    (folder / "dataset/objects/mug").chmod(0o700)
    (folder / "dataset/objects/mug/object.toml").write_text("symmetry = 1")
    return folder / "rig.toml"


def _backup(config: Path, output: Path) -> Path:
    assert main(["backup", str(output), "--config", str(config)]) == 0
    assert oct(output.stat().st_mode)[-3:] == "600"
    return output


@pytest.mark.long
def test_a_restored_site_starts_and_tracks(
    rig: RunningRig, capsys: pytest.CaptureFixture[str]
) -> None:
    before, after, models = (rig.folder / name for name in ("before", "after", "models"))
    before.mkdir()
    models.mkdir()
    shutil.copy(MODEL, models / "far.model")
    (before / "rig.toml").write_text(
        SIMULATED + f'[tracker.mug]\ncamera = "front"\nmodel = "{models}/far.model"\n'
        f'[recorder.disk]\nfolder = "recordings"\n[zenoh]\nmeeting = "{rig.meeting}"\n'
    )
    (before / "recordings").mkdir()
    (before / "recordings/one.mcap").write_text("large")
    backup = _backup(before / "rig.toml", rig.folder / "site.tar.gz")
    shutil.rmtree(before)
    shutil.rmtree(models)
    assert main(["restore", str(backup), "--to", str(after)]) == 0
    assert "Look at it before you start it: inhand doctor" in capsys.readouterr().out
    assert (models / "far.model").read_bytes() == MODEL.read_bytes()
    assert not (after / "recordings").exists()
    up = rig.inhand("up", "--config", after / "rig.toml")
    up.said("tracker mug is up")
    key = POSE.key(Site(), "mug")
    eventually("poses", lambda: rig.counted("mug", key, "published") > 0)


@pytest.mark.long
def test_a_restored_hub_starts_with_its_keys_as_private_as_they_were(rig: RunningRig) -> None:
    folder = made_site(rig.folder / "site")
    address = free_address()
    config = rig.folder / "hub.toml"
    config.write_text(
        f'realm = "{REALM}"\nrig = "{RIG}"\n'
        f'[hub.hub]\nfolder = "site/hub"\nlisten = ["{address}"]\n'
    )
    before = _tree(folder.path)
    assert "authority/key.pem" in before
    backup = _backup(config, rig.folder / "site.tar.gz")
    shutil.rmtree(folder.path)
    config.unlink()
    assert main(["restore", str(backup)]) == 0
    assert _tree(folder.path) == before
    assert oct(folder.path.stat().st_mode)[-3:] == "700"
    hub = rig.inhand("hub", "--config", config)
    hub.said("may connect")
    site = HubSite(folder, rig, address, hub)
    with site.joined("anna"):
        pass
    assert main(["hub", "add", "viewer", "bert", "--rig", RIG, "--site", str(folder.path)]) == 0


def test_what_is_restored_is_what_was_backed_up(tmp_path: Path) -> None:
    config = _small_site(tmp_path / "a")
    before = _tree(tmp_path / "a")
    backup = _backup(config, tmp_path / "site.tar.gz")
    assert main(["restore", str(backup), "--to", str(tmp_path / "b")]) == 0
    assert _tree(tmp_path / "b") == before


def test_nothing_is_written_over_unless_that_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    config = _small_site(tmp_path / "a")
    before = _tree(tmp_path / "a")
    backup = _backup(config, tmp_path / "site.tar.gz")
    config.write_text("[studio.desk]\nport = 1")
    (tmp_path / "a/secret/word").unlink()
    changed = _tree(tmp_path / "a")
    assert main(["restore", str(backup)]) == 1
    assert "rig.toml would be written over: move them away, or say" in capsys.readouterr().err
    assert _tree(tmp_path / "a") == changed
    assert main(["restore", str(backup), "--overwrite"]) == 0
    assert _tree(tmp_path / "a") == before


def _flipped(data: bytes) -> bytes:
    middle = len(data) // 2
    return data[:middle] + bytes([data[middle] ^ 8]) + data[middle + 1 :]


def _a_tar(_data: bytes) -> bytes:
    file = io.BytesIO()
    with tarfile.open(fileobj=file, mode="w:gz") as archive:
        archive.addfile(tarfile.TarInfo("holiday.jpg"), io.BytesIO())
    return file.getvalue()


@pytest.mark.parametrize(
    ("damage", "said"),
    [
        (_flipped, "is damaged"),
        (lambda data: data[: len(data) // 2], "is damaged"),
        (lambda data: data[:-9], "is damaged"),
        (lambda _: b"", "is damaged"),
        (lambda _: b"holiday", "is damaged"),
        (_a_tar, "is no backup that `inhand backup` made"),
    ],
    ids=["flipped", "cut", "cut at its end", "empty", "text", "another tar"],
)
def test_a_damaged_or_foreign_file_is_refused_and_nothing_is_written(
    tmp_path: Path,
    damage: Callable[[bytes], bytes],
    said: str,
    capsys: pytest.CaptureFixture[str],
) -> None:
    backup = _backup(_small_site(tmp_path / "a"), tmp_path / "site.tar.gz")
    backup.write_bytes(damage(backup.read_bytes()))
    capsys.readouterr()
    assert main(["restore", str(backup), "--to", str(tmp_path / "b")]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line
    assert not (tmp_path / "b").exists()


def _forged(path: Path, entries: list[tuple[str, bytes]], **manifest: Any) -> Path:
    """A backup whose list and files are these, with sums that are right."""
    stored = {"mode": 0o644, "owner": "root", "group": "root"}
    values = {
        "inhand_backup": 1,
        "inhand": "0",
        "made_at": "",
        "folder": str(path.parent / "c"),
        "configs": ["rig.toml"],
        "files": [
            {"place": name, "size": len(data), "sha256": sha256(data).hexdigest(), **stored}
            for name, data in entries
        ],
    } | manifest
    with tarfile.open(path, "w:gz") as archive:
        for name, data in [("manifest.json", json.dumps(values).encode()), *entries]:
            entry = tarfile.TarInfo(name)
            entry.size = len(data)
            if data == b"link":
                entry.type, entry.linkname, entry.size = tarfile.SYMTYPE, "../evil", 0
            archive.addfile(entry, io.BytesIO(data))
    return path


SETTINGS = ("settings/rig.toml", b'[studio.desk]\npassword_file = "word"')
FORGED = {
    "above": ([SETTINGS, ("settings/../evil", b"x")], "leads elsewhere than it should"),
    "far above": ([SETTINGS, ("elsewhere/../../evil", b"x")], "leads elsewhere"),
    "absolute": ([SETTINGS, ("/evil", b"x")], "leads elsewhere than it should"),
    "unnamed": (
        [SETTINGS, ("settings/word", b"a password"), ("settings/evil", b"x")],
        "its settings name no such file",
    ),
    "a link": ([SETTINGS, ("settings/word", b"link")], "is not there as its list says"),
    "settings above": ([("settings/../rig.toml", b"")], "leads elsewhere than it should"),
    "no settings": ([("settings/word", b"a password")], "rig.toml is missing"),
    "wrong settings": ([(SETTINGS[0], b"[studio")], "is no TOML"),
    "a file less": ([SETTINGS], "where nothing would be"),
}


@pytest.mark.parametrize("case", FORGED)
def test_a_file_that_would_go_elsewhere_than_the_settings_say_is_refused(
    tmp_path: Path, case: str, capsys: pytest.CaptureFixture[str]
) -> None:
    entries, said = FORGED[case]
    backup = _forged(tmp_path / "forged.tar.gz", entries)
    assert main(["restore", str(backup), "--to", str(tmp_path / "b/c")]) in (1, 2)
    assert said in capsys.readouterr().err
    assert sorted(tmp_path.rglob("*")) == [backup]


def test_a_backup_of_a_later_kind_says_to_update(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    backup = _forged(tmp_path / "new.tar.gz", [SETTINGS], inhand_backup=2)
    assert main(["restore", str(backup)]) == 1
    assert "update Inhand" in capsys.readouterr().err


def _full(path: Path, target: Path) -> Path:
    raise OSError(28, "No space left on device", str(path))


@pytest.mark.parametrize("fails_at", [1, 2, 3])
def test_a_restore_that_fails_amid_its_work_leaves_all_as_it_was(
    tmp_path: Path,
    fails_at: int,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    config = _small_site(tmp_path / "a")
    backup = _backup(config, tmp_path / "site.tar.gz")
    shutil.rmtree(tmp_path / "a/dataset")
    config.write_text("[studio.desk]\nport = 1")
    before = _tree(tmp_path)
    replace, calls = Path.replace, iter(range(1, 100))

    def once_full(path: Path, target: Path) -> Path:
        return (_full if next(calls) == fails_at else replace)(path, target)

    monkeypatch.setattr(Path, "replace", once_full)
    assert main(["restore", str(backup), "--overwrite"]) == 1
    assert "No space left on device; nothing was changed" in capsys.readouterr().err
    assert _tree(tmp_path) == before


def test_a_file_in_the_way_of_a_folder_changes_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    backup = _backup(_small_site(tmp_path / "a"), tmp_path / "site.tar.gz")
    (tmp_path / "b").mkdir()
    (tmp_path / "b/secret").write_text("a file")
    before = _tree(tmp_path)
    assert main(["restore", str(backup), "--to", str(tmp_path / "b")]) == 1
    assert "nothing was changed" in capsys.readouterr().err
    assert _tree(tmp_path) == before


def test_settings_that_name_what_is_not_there_are_no_backup(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    config = _small_site(tmp_path / "a")
    (tmp_path / "a/secret/word").unlink()
    output = tmp_path / "site.tar.gz"
    assert main(["backup", str(output), "--config", str(config)]) == 2
    assert "secret/word, which the settings name, is no file" in capsys.readouterr().err
    assert not output.exists()


@pytest.mark.parametrize(
    "key", ["/run/credentials/inhand-hub.service/key.pem", "$CREDENTIALS_DIRECTORY/key.pem"]
)
def test_a_key_that_systemd_gives_is_named_as_missing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], key: str
) -> None:
    config = _small_site(tmp_path / "a", **{"hub.toml": f'[hub.hub]\nkey = "{key}"'})
    backup = _backup(config.with_name("hub.toml"), tmp_path / "site.tar.gz")
    assert f"NOT in it: {key}, which systemd gives" in capsys.readouterr().out
    assert main(["restore", str(backup), "--to", str(tmp_path / "b")]) == 0


def test_a_site_of_absolute_paths_is_not_restored_to_another_folder(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = f'[studio.desk]\npassword_file = "{tmp_path}/a/secret/word"'
    backup = _backup(_small_site(tmp_path / "a", **{"rig.toml": text}), tmp_path / "site.tar.gz")
    assert main(["restore", str(backup), "--to", str(tmp_path / "b")]) != 0
    assert "restore it without --to" in capsys.readouterr().err
    assert not (tmp_path / "b").exists()
    shutil.rmtree(tmp_path / "a")
    assert main(["restore", str(backup)]) == 0
    assert (tmp_path / "a/secret/word").exists()


def _kept(config: Path) -> list[str]:
    """The kinds of the outcomes that a site's database has."""
    saver = new_saver(config.parent)
    try:
        return [one.outcome.kind for one in latest(saver.database, 10)]
    finally:
        saver.database.close()


NOON_NS = at("2026-03-01 12:00")


@pytest.fixture
def keeping(tmp_path: Path) -> Iterator[tuple[Path, Saver]]:
    """The settings of a site with outcomes, and a daemon's hold of their database."""
    config = _small_site(tmp_path / "a", **{"rig.toml": "[outcomes.home]"})
    saver = new_saver(config.parent)
    saver.save([sip(NOON_NS)])
    yield config, saver
    saver.database.close()


def test_outcomes_are_backed_up_while_a_daemon_writes_them(
    tmp_path: Path, keeping: tuple[Path, Saver]
) -> None:
    config, saver = keeping
    with saver.database.writing() as session:
        session.execute(delete(OutcomeRow))
        backup = _backup(config, tmp_path / "site.tar.gz")
    assert {path.name for path in tmp_path.iterdir()} == {"a", "site.tar.gz"}
    assert main(["restore", str(backup), "--to", str(tmp_path / "b")]) == 0
    assert _kept(tmp_path / "b/rig.toml") == ["sip"]
    assert _kept(config) == []


def test_outcomes_do_not_come_back_under_a_daemon_that_runs(
    tmp_path: Path, keeping: tuple[Path, Saver], capsys: pytest.CaptureFixture[str]
) -> None:
    config, saver = keeping
    backup = _backup(config, tmp_path / "site.tar.gz")
    saver.save([sip(NOON_NS + 60 * S, kind="refill")])
    assert main(["restore", str(backup), "--overwrite"]) == 1
    assert "outcomes.db-wal belongs to the database that is there" in capsys.readouterr().err
    assert len(_kept(config)) == 2
    saver.database.close()
    assert main(["restore", str(backup), "--overwrite"]) == 0
    assert _kept(config) == ["sip"]


def test_a_damaged_database_is_no_part_of_a_backup(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    config = _small_site(tmp_path / "a", **{"rig.toml": "[outcomes.home]"})
    config.with_name("outcomes.db").write_bytes(b"SQLite format 3\0" + bytes(4000))
    output = tmp_path / "site.tar.gz"
    assert main(["backup", str(output), "--config", str(config)]) == 1
    assert "the database" in capsys.readouterr().err
    assert not output.exists()


def test_a_database_that_is_not_there_yet_or_is_a_server_s_is_no_part_of_a_backup(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    address = "postgresql+psycopg://inhand@db.local/home"
    tables = f'[outcomes.new]\n[outcomes.home]\ndatabase = "{address}"'
    backup = _backup(_small_site(tmp_path / "a", **{"rig.toml": tables}), tmp_path / "site.tar.gz")
    assert f"NOT in it: {address}: have its server back it up" in capsys.readouterr().out
    assert main(["restore", str(backup), "--to", str(tmp_path / "b")]) == 0
    assert not (tmp_path / "b/outcomes.db").exists()


def test_what_a_smart_home_s_broker_needs_is_in_a_backup(tmp_path: Path) -> None:
    broker = 'host = "home.local"\nuser = "inhand"\npassword_file = "word"\nauthority = "ca.pem"'
    files = {"rig.toml": f"[outcomes.home.homeassistant]\n{broker}", "word": "x", "ca.pem": "y"}
    backup = _backup(_small_site(tmp_path / "a", **files), tmp_path / "site.tar.gz")
    assert main(["restore", str(backup), "--to", str(tmp_path / "b")]) == 0
    assert (tmp_path / "b/word").read_text() == "x"
    assert (tmp_path / "b/ca.pem").read_text() == "y"

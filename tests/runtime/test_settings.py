"""Settings from file and environment, and the lines about what is wrong with them."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal

import pytest
from inhand_runtime.errors import SettingsError
from inhand_runtime.settings import (
    Credentials,
    FilePath,
    Login,
    Section,
    Settings,
    load_rig_file,
    load_settings,
)
from inhand_schemas.keys import Site


class CameraSettings(Section):
    """A daemon's settings."""

    source: str
    rate: float = 1.0
    mode: Literal["fast", "slow"] | Literal["exact"] = "fast"
    serial: str | None = None
    images: frozenset[Literal["colour", "depth"]] = frozenset()
    places: tuple[str, ...] = ()
    file: FilePath = Path("camera.yaml")
    options: dict[str, Any] = {}


Load = Callable[..., Settings[CameraSettings]]


@pytest.fixture
def load(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Load:
    """Load the camera's settings from a text and variables, and nothing else."""
    for variable in os.environ:
        if variable.upper().startswith("INHAND_"):
            monkeypatch.delenv(variable)
    monkeypatch.chdir(tmp_path)

    def load_text(text: str, name: str | None = None, **env: str) -> Settings[CameraSettings]:
        Path("rig.toml").write_text(text)
        for variable, value in env.items():
            monkeypatch.setenv(variable, value)
        return load_settings(Path("rig.toml"), "capture", CameraSettings, name)

    return load_text


def test_an_instance_gets_its_own_table_and_the_shared_ones(load: Load) -> None:
    settings = load(
        'realm = "home"\nrig = "kitchen"\n'
        '[zenoh]\nconnect = ["tcp/10.0.0.1:7447"]\n'
        '[capture.front]\nsource = "simulator"\n[capture.front.options]\nseed = 3\n'
    )
    assert settings.site == Site("home", "kitchen")
    assert settings.zenoh.connect == ("tcp/10.0.0.1:7447",)
    assert settings.instance == "front"
    assert settings.service == CameraSettings(source="simulator", options={"seed": 3})


def test_the_folder_for_caches_is_no_setting(load: Load) -> None:
    loaded = load("[capture.front]\nsource = 'replay'", INHAND_CACHE="/var/cache/inhand")
    assert loaded.service.source == "replay"


def test_the_environment_goes_over_the_file_value_by_value(load: Load) -> None:
    settings = load(
        '[capture.front]\nsource = "simulator"\nrate = 2\n',
        INHAND_CAPTURE__FRONT__SOURCE="replay",
        INHAND_CAPTURE__FRONT__OPTIONS__FILE="/data/A.mcap",
        INHAND_LOG__LEVEL="debug",
    )
    expected = CameraSettings(source="replay", rate=2, options={"file": "/data/A.mcap"})
    assert settings.service == expected
    assert settings.log.level == "debug"


def test_without_a_file_an_instance_is_called_like_its_service() -> None:
    class AllDefaults(Section):
        speed: int = 1

    assert load_settings(None, "tracker", AllDefaults).instance == "tracker"


@pytest.mark.parametrize(
    ("text", "line"),
    [
        (
            '[capture.front]\nsource = "x"\n\nratte = 2\n',
            "rig.toml:4: unknown setting capture.front.ratte (did you mean rate?)",
        ),
        ("[capture.front]\nrate = 1\n", "rig.toml:1: setting capture.front.source is missing"),
        (
            '[capture.front]\nsource = "x"\nrate = "fast"\n',
            "rig.toml:3: setting capture.front.rate: "
            "Input should be a valid number, unable to parse string as a number",
        ),
        ("[zenho]\n", "rig.toml:1: unknown setting zenho (did you mean zenoh?)"),
        (
            '[zenoh]\nmoode = "peer"\n',
            "rig.toml:2: unknown setting zenoh.moode (did you mean mode?)",
        ),
        (
            '[zenoh]\nmeeting = "localhost"\n',
            "rig.toml:2: setting zenoh.meeting: 'localhost' is no address; "
            "write it as tcp/127.0.0.1:7447",
        ),
        (
            '[capture]\nsource = "x"\n',
            "rig.toml:2: capture.source stands in no instance: write it below [capture.NAME]",
        ),
        (
            '[capture.front]\nsource = "x"\nmode = "fsat"\n',
            "rig.toml:3: setting capture.front.mode: there is no 'fsat' (did you mean fast?)",
        ),
        (
            '[capture.front]\nsource = "x"\nmode = 3\n',
            "rig.toml:3: setting capture.front.mode: there is no 3 (there are: fast, slow, exact)",
        ),
        (
            '[capture.front]\nsource = "x"\nimages = ["deep"]\n',
            "rig.toml:3: setting capture.front.images.0: there is no 'deep' (did you mean depth?)",
        ),
        (
            '[log]\nlevel = "INFO"\n',
            "rig.toml:2: setting log.level: there is no 'INFO' (did you mean info?)",
        ),
        (
            '[zenoh]\nmode = "client"\n',
            'rig.toml:2: zenoh.mode = "client" needs zenoh.connect, the addresses of hubs',
        ),
        (
            "[log]\nxyz = 1\n",
            "rig.toml:2: unknown setting log.xyz (there are: format, level)",
        ),
        (
            'realm = "My home"\n',
            "rig.toml: realm 'My home' is no name: "
            "use 1 to 64 of the letters a-z, digits and underscore",
        ),
        (
            '[capture.Front]\nsource = "x"\n',
            "rig.toml: instance 'Front' is no name: "
            "use 1 to 64 of the letters a-z, digits and underscore",
        ),
        (
            '[capture.a]\nsource = "x"\n[capture.b]\nsource = "x"\n',
            "rig.toml names several instances of capture; add --name with one of: a, b",
        ),
        ("a = = 1\n", "rig.toml is no TOML: Invalid value (at line 1, column 5)"),
    ],
)
def test_a_wrong_file_is_told_with_line_and_mend(load: Load, text: str, line: str) -> None:
    with pytest.raises(SettingsError) as refused:
        load(text)
    assert str(refused.value) == line


@pytest.mark.parametrize(
    ("variable", "value", "line"),
    [
        (
            "INHAND_CAPTRE__FRONT__SOURCE",
            "x",
            "environment variable INHAND_CAPTRE__FRONT__SOURCE sets nothing: "
            "'captre' is no setting (did you mean capture?)",
        ),
        (
            "INHAND_ZENOH__MOODE",
            "peer",
            "environment variable INHAND_ZENOH__MOODE: "
            "unknown setting zenoh.moode (did you mean mode?)",
        ),
        (
            "INHAND_CAPTURE__FRONT__RATE",
            "fast",
            "environment variable INHAND_CAPTURE__FRONT__RATE: setting capture.front.rate: "
            "Input should be a valid number, unable to parse string as a number",
        ),
    ],
)
def test_a_wrong_variable_is_told_by_its_name(
    load: Load, variable: str, value: str, line: str
) -> None:
    with pytest.raises(SettingsError) as refused:
        load('[capture.front]\nsource = "x"\n', **{variable: value})
    assert str(refused.value) == line


@pytest.mark.parametrize("text", ["tcp/10.0.0.1:7447", '["tcp/10.0.0.1:7447"'])
def test_a_list_in_the_environment_must_be_json(load: Load, text: str) -> None:
    with pytest.raises(SettingsError) as refused:
        load("", INHAND_ZENOH__CONNECT=text)
    assert str(refused.value) == (
        "environment variable INHAND_ZENOH__CONNECT: setting zenoh.connect: "
        'write lists and tables as JSON, such as ["a", "b"]'
    )


def test_lists_and_tables_are_read_from_json_at_every_depth(load: Load) -> None:
    settings = load(
        '[capture.front]\nsource = "x"\n[capture.front.options]\nkept = 1\n',
        INHAND_ZENOH__CONNECT='["tcp/10.0.0.1:7447"]',
        INHAND_CAPTURE__FRONT__PLACES='["door", "7"]',
        INHAND_CAPTURE__FRONT__OPTIONS='{"gains": [1, 2]}',
        INHAND_CAPTURE__FRONT__OPTIONS__LENS='{"k": [0.5]}',
        INHAND_LOG='{"level": "debug"}',
    )
    assert settings.zenoh.connect == ("tcp/10.0.0.1:7447",)
    assert settings.service.places == ("door", "7")
    assert settings.service.options == {"kept": 1, "gains": [1, 2], "lens": {"k": [0.5]}}
    assert settings.log.level == "debug"


def test_digits_stay_text_where_text_is_wanted_and_become_numbers_where_numbers_are(
    load: Load,
) -> None:
    settings = load(
        '[capture.front]\nsource = "x"\n',
        INHAND_CAPTURE__FRONT__SERIAL="1844301041",
        INHAND_CAPTURE__FRONT__RATE="2.5",
        INHAND_CAPTURE__FRONT__OPTIONS__SERIAL="1844301041",
    )
    assert settings.service.serial == "1844301041"
    assert settings.service.rate == 2.5
    assert settings.service.options == {"serial": "1844301041"}
    assert type(settings.service.options["serial"]) is str


def test_a_variable_below_what_is_no_table_is_refused(load: Load) -> None:
    with pytest.raises(SettingsError, match="RIG__NAME sets nothing: 'rig' is no table"):
        load('rig = "kitchen"\n', INHAND_RIG__NAME="x")


def test_relative_paths_follow_the_files_folder(
    load: Load, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    load('[capture.front]\nsource = "x"\nfile = "calibration/front.yaml"\n')
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    monkeypatch.chdir(elsewhere)
    for config in (tmp_path / "rig.toml", Path("../rig.toml")):
        settings = load_settings(config, "capture", CameraSettings)
        assert settings.service.file == config.parent / "calibration/front.yaml"
    monkeypatch.setenv("INHAND_CAPTURE__FRONT__FILE", "other.yaml")
    settings = load_settings(tmp_path / "rig.toml", "capture", CameraSettings)
    assert settings.service.file == tmp_path / "other.yaml"
    monkeypatch.setenv("INHAND_CAPTURE__FRONT__FILE", "/absolute.yaml")
    settings = load_settings(tmp_path / "rig.toml", "capture", CameraSettings)
    assert settings.service.file == Path("/absolute.yaml")


def test_a_path_below_the_credentials_is_what_systemd_gives_the_service(load: Load) -> None:
    text = '[capture.front]\nsource = "x"\nfile = "$CREDENTIALS_DIRECTORY/word"\n'
    assert load(text).service.file == Path("$CREDENTIALS_DIRECTORY/word")
    given = "/run/credentials/inhand-capture@front.service"
    assert load(text, CREDENTIALS_DIRECTORY=given).service.file == Path(given, "word")


def test_without_a_file_relative_paths_follow_the_current_folder(load: Load) -> None:
    load("", INHAND_CAPTURE__FRONT__SOURCE="x", INHAND_CAPTURE__FRONT__FILE="here.yaml")
    assert load_settings(None, "capture", CameraSettings).service.file == Path("here.yaml")


def test_a_byte_order_mark_is_passed_over(tmp_path: Path) -> None:
    path = tmp_path / "rig.toml"
    path.write_text('rig = "kitchen"\n', encoding="utf-8-sig")
    assert load_rig_file(path).rig == "kitchen"
    path.write_text("[zenho]\n", encoding="utf-8-sig")
    with pytest.raises(SettingsError, match=r"rig\.toml:1: unknown setting zenho"):
        load_rig_file(path)


def test_a_file_in_another_encoding_is_told_as_such(tmp_path: Path) -> None:
    path = tmp_path / "rig.toml"
    path.write_text('rig = "kitchen"\n', encoding="utf-16")
    with pytest.raises(SettingsError, match=r"rig\.toml is no UTF-8 text: save it as UTF-8"):
        load_rig_file(path)
    path.write_text('rig = "küche"\n', encoding="latin-1")
    with pytest.raises(SettingsError, match="save it as UTF-8"):
        load_rig_file(path)
    path.write_bytes(b"PK\x03\x04\x00\x00\xff")
    with pytest.raises(SettingsError, match=r"is no text: name the rig's settings \(TOML\)"):
        load_rig_file(path)


def test_an_instance_that_the_file_does_not_name_is_refused(load: Load) -> None:
    with pytest.raises(SettingsError, match=r"has no \[capture\.fornt\] \(did you mean front\?\)"):
        load('[capture.front]\nsource = "x"\n', "fornt")


def test_a_missing_file_is_named() -> None:
    with pytest.raises(SettingsError, match=r"cannot read /nowhere/rig\.toml: No such file"):
        load_rig_file(Path("/nowhere/rig.toml"))


FILES = 'certificate = "c.pem"\nkey = "k.pem"\nauthority = "a.pem"\n'


LOGIN = 'user = "home.anna"\npassword = "password"\nauthority = "a.pem"\n'


def test_a_client_s_password_stands_beside_the_settings(tmp_path: Path) -> None:
    path = tmp_path / "rig.toml"
    path.write_text(f'[zenoh]\nmode = "client"\nconnect = ["tls/hub.local:7448"]\n{LOGIN}')
    zenoh = load_rig_file(path).zenoh
    assert zenoh.login == Login("home.anna", tmp_path / "password", tmp_path / "a.pem")
    assert zenoh.credentials is None
    assert zenoh.joins_hub


def test_a_client_s_files_stand_beside_the_settings(load: Load, tmp_path: Path) -> None:
    zenoh = f'[zenoh]\nmode = "client"\nconnect = ["tls/hub.local:7448"]\n{FILES}'
    given = load(f"{zenoh}[capture.front]\nsource = 'replay'").zenoh.credentials
    assert given is not None
    assert given == Credentials(Path("c.pem"), Path("k.pem"), Path("a.pem"))
    (tmp_path / "below").mkdir()
    (tmp_path / "below/rig.toml").write_text(zenoh)
    beside = load_rig_file(tmp_path / "below/rig.toml").zenoh.credentials
    assert beside is not None
    assert beside.certificate == tmp_path / "below/c.pem"


@pytest.mark.parametrize(
    ("zenoh", "words"),
    [
        (
            'mode = "client"\nconnect = ["tls/hub:7448"]\ncertificate = "c.pem"\n',
            "belong together: key is missing",
        ),
        ('mode = "client"\nconnect = ["tls/hub:7448"]\n', "tls/hub:7448 needs certificate"),
        (f'mode = "client"\nconnect = ["tcp/hub:7447"]\n{FILES}', "begin with tls/"),
        (FILES, 'are for mode = "client"'),
        (LOGIN.replace("password", "# "), "belong together: password is missing"),
        (f'{LOGIN}key = "k.pem"\n', "a certificate or a password: leave one out"),
        (LOGIN, 'user, password and authority are for mode = "client"'),
    ],
)
def test_a_client_s_files_that_do_nothing_are_refused(load: Load, zenoh: str, words: str) -> None:
    with pytest.raises(SettingsError, match=words) as raised:
        load(f"[zenoh]\n{zenoh}[capture.front]\nsource = 'replay'")
    assert "rig.toml:1: setting zenoh: " in str(raised.value)


def test_settings_of_a_later_version_are_refused_and_of_this_one_or_none_are_read(
    tmp_path: Path,
) -> None:
    path = tmp_path / "rig.toml"
    for text in ('rig = "attic"\n', 'version = 1\nrig = "attic"\n'):
        path.write_text(text)
        assert load_rig_file(path).rig == "attic"
    path.write_text("# new\nversion = 2\n[recorder.disk]\n")
    with pytest.raises(SettingsError, match=r"rig\.toml:2: setting version: .*: update Inhand"):
        load_rig_file(path)

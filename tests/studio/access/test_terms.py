"""What settings of the gate are refused, and that no password is ever shown."""

import os
from pathlib import Path

import pytest
from gated import PASSWORD, certificate, password_file
from inhand_runtime.errors import SettingsError
from inhand_runtime.settings import Origin
from inhand_studio.access.settings import AccessSettings
from inhand_studio.access.terms import terms_of
from running_rig import RunningRig


def test_on_this_machine_alone_no_password_is_needed(caplog: pytest.LogCaptureFixture) -> None:
    for host in ("127.0.0.1", "localhost", "127.8.8.8"):
        terms = terms_of(AccessSettings(host=host))
        assert not terms.elsewhere
        assert terms.password is None
    assert not caplog.text


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.0.2.1"])
def test_where_other_machines_reach_it_a_password_is_needed(host: str) -> None:
    with pytest.raises(SettingsError, match="give it a password_file"):
        terms_of(AccessSettings(host=host))


def test_without_encryption_other_machines_are_warned_of(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    settings = {"host": "0.0.0.0", "password_file": password_file(tmp_path)}
    terms_of(AccessSettings(**settings, **certificate(tmp_path)))  # type: ignore[arg-type]
    assert not caplog.text
    terms = terms_of(AccessSettings(**settings))  # type: ignore[arg-type]
    assert "not encrypted" in caplog.text
    assert terms.password is not None
    assert terms.password.matches(PASSWORD)
    assert not terms.password.matches(PASSWORD + " ")


@pytest.mark.parametrize(
    ("text", "reason"),
    [("short\n", "short"), ("", "short"), ("one line too\nmany for it\n", "several lines")],
)
def test_a_password_file_that_cannot_be_meant_is_refused_without_showing_it(
    tmp_path: Path, text: str, reason: str
) -> None:
    with pytest.raises(SettingsError, match=reason) as refused:
        terms_of(AccessSettings(password_file=password_file(tmp_path, text)))
    assert not any(
        line and line in str(refused.value) for line in text.split("\n")[:1] if line != "short"
    )


def test_a_password_file_that_all_may_read_is_warned_of(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    path = password_file(tmp_path)
    path.chmod(0o644)
    terms_of(AccessSettings(password_file=path))
    assert "chmod 600" in caplog.text


def test_files_that_are_not_there_or_no_pair_are_refused_by_name(tmp_path: Path) -> None:
    gone = tmp_path / "gone"
    with pytest.raises(SettingsError, match=r"cannot read password_file .*gone"):
        terms_of(AccessSettings(password_file=gone))
    files = certificate(tmp_path)
    with pytest.raises(SettingsError, match=r"cannot read private_key .*gone"):
        terms_of(AccessSettings(certificate=files["certificate"], private_key=gone))
    (tmp_path / "other").mkdir()
    other = certificate(tmp_path / "other")
    with pytest.raises(SettingsError, match="no pair"):
        terms_of(AccessSettings(certificate=files["certificate"], private_key=other["private_key"]))
    with pytest.raises(SettingsError, match="no pair"):
        terms_of(
            AccessSettings(certificate=password_file(tmp_path), private_key=gone.parent / "key.pem")
        )


def test_an_encrypted_key_is_refused_and_asks_nobody(tmp_path: Path) -> None:
    files = certificate(tmp_path)
    locked = tmp_path / "locked.pem"
    pair = f"openssl pkey -aes256 -passout pass:secret -in {files['private_key']} -out {locked}"
    assert os.system(pair) == 0
    with pytest.raises(SettingsError, match="is encrypted"):
        terms_of(AccessSettings(certificate=files["certificate"], private_key=locked))


def test_settings_that_exclude_or_need_each_other_are_refused() -> None:
    origin = Origin()
    with pytest.raises(SettingsError, match="exclude each other"):
        origin.checked({"password": PASSWORD, "password_file": "x"}, AccessSettings)
    with pytest.raises(SettingsError, match="belong together"):
        origin.checked({"certificate": "x"}, AccessSettings)


def test_a_password_is_in_no_text_of_settings_terms_or_faults() -> None:
    settings = AccessSettings(password=PASSWORD)  # type: ignore[arg-type]
    terms = terms_of(settings)
    for text in (
        repr(settings),
        str(settings),
        settings.model_dump_json(),
        repr(terms),
        repr(vars(terms.password)),
    ):
        assert PASSWORD not in text
    for values in (
        {"password": "secret"},
        {"password": ["secret-in-a-list"]},
        {"password": PASSWORD, "certificate": "x"},
    ):
        with pytest.raises(SettingsError) as refused:
            Origin().checked(values, AccessSettings)
        assert "secret" not in str(refused.value)
        assert PASSWORD not in str(refused.value)


@pytest.mark.long
def test_the_daemon_takes_its_password_from_the_environment_and_does_not_start_without(
    rig: RunningRig,
) -> None:
    rig.configure('[studio.desk]\nhost = "0.0.0.0"\nport = 0\n')
    refused = rig.done("studio", "--config", rig.config)
    assert refused.popen.returncode == 2
    assert "give it a password_file" in refused.stderr
    given = rig.inhand("studio", "--config", rig.config, INHAND_STUDIO__DESK__PASSWORD=PASSWORD)
    given.said("the studio is at http://0.0.0.0:")
    assert given.stop() == 0
    assert "is not encrypted" in given.stderr
    assert PASSWORD not in given.stderr + given.stdout

"""What is wrong with a certificate is said before anything connects."""

import datetime
import logging
from collections.abc import Callable
from pathlib import Path

import pytest
from inhand_hub.certificates import (
    Issued,
    Validity,
    hub_certificate,
    key_pem,
    member_certificate,
    new_authority,
    new_key,
)
from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.hub_access import require_usable
from inhand_runtime.settings import Credentials

DAY = datetime.timedelta(days=1)
AUTHORITY = new_authority("An authority")
FOREIGN = new_authority("Another authority")


def member(begin_days: float, end_days: float, by: Issued = AUTHORITY) -> Issued:
    """A member's certificate that is valid between these days from now."""
    now = datetime.datetime.now(datetime.UTC)
    valid = Validity(now + begin_days * DAY, now + end_days * DAY)
    return member_certificate(by, "kitchen.front.0", new_key(), valid)


def written(folder: Path, issued: Issued) -> Credentials:
    given = Credentials(
        *(folder / name for name in ("certificate.pem", "key.pem", "authority.pem"))
    )
    given.certificate.write_bytes(issued.certificate)
    given.key.write_bytes(key_pem(issued.key))
    given.key.chmod(0o600)
    given.authority.write_bytes(AUTHORITY.certificate)
    return given


def test_a_valid_certificate_is_taken_without_a_word(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    require_usable(written(tmp_path, member(-1, 300)))
    hub = hub_certificate(AUTHORITY, "the hub", new_key(), ("localhost", "127.0.0.1", "::1"))
    require_usable(written(tmp_path, hub), serves=True)
    assert not caplog.records


def test_one_that_ends_soon_asks_for_renewal(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level(logging.WARNING):
        require_usable(written(tmp_path, member(-1, 12.5)))
    assert "ends in 12 days" in caplog.text
    assert "inhand hub renew" in caplog.text


def test_a_key_that_others_may_read_is_named(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    given = written(tmp_path, member(-1, 300))
    given.key.chmod(0o640)
    with caplog.at_level(logging.WARNING):
        assert 299 < require_usable(given) < 301
    assert "may read key" in caplog.text


@pytest.mark.parametrize(
    ("issued", "words"),
    [
        (lambda: member(-9, -1), "has expired, or this machine's clock is wrong"),
        (lambda: member(1, 9), "not valid yet: is this machine's clock right"),
    ],
    ids=["expired", "not yet valid"],
)
def test_a_time_that_does_not_fit_may_be_the_clock_s_fault(
    tmp_path: Path, issued: Callable[[], Issued], words: str
) -> None:
    with pytest.raises(InhandError, match=words) as raised:
        require_usable(written(tmp_path, issued()))
    assert not isinstance(raised.value, SettingsError)  # starting again can help


def test_a_foreign_certificate_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SettingsError, match="is none that authority"):
        require_usable(written(tmp_path, member(-1, 9, by=FOREIGN)))


def test_the_hub_s_certificate_is_no_member_s_and_the_other_way_round(tmp_path: Path) -> None:
    hub = hub_certificate(AUTHORITY, "the hub", new_key(), ("localhost",))
    for issued, serves in ((hub, False), (member(-1, 9), True)):
        with pytest.raises(SettingsError, match="is none that authority"):
            require_usable(written(tmp_path, issued), serves=serves)


def _without(name: str) -> Callable[[Credentials], None]:
    return lambda given: getattr(given, name).unlink()


def _nonsense(name: str) -> Callable[[Credentials], None]:
    return lambda given: getattr(given, name).write_bytes(b"nonsense")


def _another_key(given: Credentials) -> None:
    given.key.write_bytes(key_pem(new_key()))


def _encrypted_key(given: Credentials) -> None:
    from cryptography.hazmat.primitives import serialization

    given.key.write_bytes(
        new_key().private_bytes(
            serialization.Encoding.PEM,
            serialization.PrivateFormat.PKCS8,
            serialization.BestAvailableEncryption(b"secret"),
        )
    )


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (_without("certificate"), "cannot read certificate .*No such file"),
        (_without("key"), "cannot read key .*No such file"),
        (_without("authority"), "cannot read authority .*No such file"),
        (_nonsense("certificate"), "no pair of PEM files"),
        (_nonsense("key"), "no pair of PEM files"),
        (_nonsense("authority"), "authority .* is no certificate"),
        (_another_key, "no pair of PEM files"),
        (_encrypted_key, "key .* is encrypted"),
    ],
)
def test_files_that_cannot_be_used_are_one_line_without_their_content(
    tmp_path: Path, spoil: Callable[[Credentials], None], words: str
) -> None:
    given = written(tmp_path, member(-1, 9))
    secret = given.key.read_text().splitlines()[1]
    spoil(given)
    with pytest.raises(SettingsError, match=words) as raised:
        require_usable(given)
    assert "\n" not in str(raised.value)
    assert secret not in str(raised.value) + repr(given)

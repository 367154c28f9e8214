"""A site's folder: who gets what, with which rights, and what a crash leaves behind."""

import contextlib
import os
import shutil
import stat
from collections.abc import Callable
from pathlib import Path

import pytest
from cryptography import x509
from hub_site import OTHER_RIG, REALM, RIG
from inhand_hub import site_folder
from inhand_hub.certificates import load_issued
from inhand_hub.site_folder import SiteFolder, create_site
from inhand_runtime.errors import InhandError, SettingsError
from inhand_runtime.hub_access import require_usable
from inhand_runtime.settings import Credentials

HOSTS = ("hub.local", "127.0.0.1", "::1")


class CrashError(BaseException):
    """The process ends here: nothing is cleaned up."""


@pytest.fixture
def site(tmp_path: Path) -> SiteFolder:
    """A site of two rigs, and nobody in it."""
    return create_site(tmp_path / "site", REALM, (RIG, OTHER_RIG), HOSTS)


def files_of(folder: Path) -> Credentials:
    return Credentials(*(folder / f"{name}.pem" for name in ("certificate", "key", "authority")))


def contents(folder: Path) -> dict[str, bytes]:
    """All files below a folder, but for what a crash left unfinished."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and "unfinished" not in str(path.relative_to(folder))
    }


def test_only_its_owner_reads_any_of_it_whatever_the_umask(tmp_path: Path) -> None:
    before = os.umask(0)
    try:
        site = create_site(tmp_path / "site", REALM, (RIG,), HOSTS)
        site.add("camera", "front", RIG, ())
        site.renew("front")
        site.renew("hub")
    finally:
        os.umask(before)
    for path in (site.path, *site.path.rglob("*")):
        assert stat.S_IMODE(path.stat().st_mode) == (0o700 if path.is_dir() else 0o600), path


def test_the_hub_and_a_member_can_use_what_they_are_given(site: SiteFolder) -> None:
    member = site.add("tracker", "mug", RIG, ("mug", "pan"))
    assert member.objects == ("mug", "pan")
    require_usable(files_of(site.hub), serves=True)
    require_usable(files_of(site.folder_of(member)))
    assert site.load().members == (member,)
    assert not [path for path in site.hub.iterdir() if "authority/key" in str(path)]
    key = (site.path / "authority" / "key.pem").read_bytes()
    assert [name for name, data in contents(site.path).items() if data == key] == (
        ["authority/key.pem"]
    )


def test_nothing_is_overwritten(site: SiteFolder) -> None:
    site.add("camera", "front", RIG, ())
    before = contents(site.path)
    with pytest.raises(SettingsError, match="is there already, and stays"):
        create_site(site.path, REALM, (RIG,), HOSTS)
    with pytest.raises(SettingsError, match="kitchen/front is a camera already"):
        site.add("viewer", "front", RIG, ())
    assert contents(site.path) == before


@pytest.mark.parametrize(
    ("add", "words"),
    [
        (lambda site: site.add("camera", "front", "attic", ()), "no rig 'attic'"),
        (lambda site: site.add("camera", "hub", RIG, ()), "name hub is the hub's own"),
        (lambda site: site.add("camera", "f" * 60, RIG, ()), "too long for a certificate"),
        (lambda site: site.add("tracker", "second", RIG, ("pan", "mug")), "pose of mug already"),
        (lambda site: site.add_hub("first", HOSTS, far=False), "first is there already"),
        (lambda site: site.add_hub("hub", HOSTS, far=False), "hub is there already"),
        (lambda site: site.add_hub("barn", ("a b",), far=False), "'a b' is no host"),
        (lambda site: site.renew("nobody"), "no member 'nobody' .*kitchen/first"),
        (lambda site: site.revoke("nobody"), "no member 'nobody'"),
    ],
)
def test_what_cannot_be_is_refused_and_changes_nothing(
    site: SiteFolder, add: Callable[[SiteFolder], object], words: str
) -> None:
    site.add("tracker", "first", RIG, ("mug",))
    before = contents(site.path)
    with pytest.raises(SettingsError, match=words):
        add(site)
    assert contents(site.path) == before


def test_a_name_of_two_rigs_is_named_with_its_rig(site: SiteFolder) -> None:
    for rig in (RIG, OTHER_RIG):
        site.add("camera", "front", rig, ())
    with pytest.raises(SettingsError, match="kitchen/front or garage/front"):
        site.revoke("front")
    site.revoke("garage/front")
    assert [one.place for one in site.load().members] == ["kitchen/front"]


def test_a_renewal_has_the_same_key_and_name_and_a_later_end(site: SiteFolder) -> None:
    member = site.add("camera", "front", RIG, ())
    folder = site.folder_of(member)
    key, before = (folder / "key.pem").read_bytes(), (folder / "certificate.pem").read_bytes()
    ended = site.load().ends_at[member.common_name]
    certificate = site.renew("front")
    assert certificate == folder / "certificate.pem"
    assert certificate.read_bytes() != before
    assert (folder / "key.pem").read_bytes() == key
    issued = load_issued(certificate.read_bytes(), key)
    assert issued.ends_at == site.load().ends_at[member.common_name] >= ended
    assert site.load().members == (member,)
    require_usable(files_of(folder))


def test_who_is_revoked_and_joins_again_is_another_for_the_hub(site: SiteFolder) -> None:
    first = site.add("camera", "front", RIG, ())
    site.revoke("front")
    assert site.load().members == ()
    assert site.load().ends_at == {}
    assert not site.folder_of(first).exists()
    assert site.add("camera", "front", RIG, ()).common_name != first.common_name


def test_a_further_hub_has_what_it_needs_to_serve_and_to_connect(site: SiteFolder) -> None:
    linked = site.add_hub("barn", HOSTS, far=True)
    folder = site.folder_of_hub("barn")
    for serves in (True, False):
        require_usable(files_of(folder), serves=serves)
    site.add("camera", "front", RIG, ())
    assert (folder / "members.json").read_bytes() == (site.hub / "members.json").read_bytes()
    key, before = (folder / "key.pem").read_bytes(), (folder / "certificate.pem").read_bytes()
    certificate = site.renew("barn")
    assert certificate.read_bytes() != before
    assert (folder / "key.pem").read_bytes() == key
    (renewed,) = site.load().hubs
    assert (renewed.common_name, renewed.far) == (linked.common_name, True)
    assert site.revoke("barn") == renewed
    assert site.load().hubs == ()
    assert not folder.exists()


def test_each_hub_has_rules_for_those_that_it_is_linked_with(site: SiteFolder) -> None:
    barn, shed = (site.add_hub(name, HOSTS, far=False) for name in ("barn", "shed"))
    first = load_issued(
        (site.hub / "certificate.pem").read_bytes(), (site.hub / "key.pem").read_bytes()
    )
    loaded = site.load()
    assert set(loaded.links_of("hub")) == {barn.common_name, shed.common_name}
    assert set(loaded.links_of("barn")) == {loaded.hub_name}
    subject = x509.load_pem_x509_certificate(first.certificate).subject
    assert subject.rfc4514_string() == f"CN={loaded.hub_name}"


STEPS = ("replace", "rename", "mkdir", "unlink")


@pytest.mark.long
@pytest.mark.parametrize("step", range(12))
@pytest.mark.parametrize("act", ["init", "add", "renew", "revoke", "renew hub"])
def test_a_crash_at_any_step_leaves_the_site_as_it_was_or_as_it_is_to_be(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, act: str, step: int
) -> None:
    path = tmp_path / "site"
    acts: dict[str, Callable[[], object]] = {
        "init": lambda: create_site(path, REALM, (RIG,), HOSTS),
        "add": lambda: SiteFolder(path).add("camera", "front", RIG, ()),
        "renew": lambda: SiteFolder(path).renew("old"),
        "renew hub": lambda: SiteFolder(path).renew("hub"),
        "revoke": lambda: SiteFolder(path).revoke("old"),
    }
    if act != "init":
        create_site(path, REALM, (RIG,), HOSTS).add("camera", "old", RIG, ())
    with monkeypatch.context() as broken:
        crash_at(broken, step)
        with contextlib.suppress(CrashError):
            acts[act]()
    if act == "init":
        if not path.exists():
            acts[act]()
        assert SiteFolder(path).load().members == ()
        require_usable(files_of(path / "hub"), serves=True)
        return
    site = SiteFolder(path)
    for member in site.load().members:
        require_usable(files_of(site.folder_of(member)))
    require_usable(files_of(site.hub), serves=True)
    before = {"old"}
    after = {"add": {"old", "front"}, "revoke": set[str]()}.get(act, before)
    names = {one.name for one in site.load().members}
    assert names in (before, after)
    if names == before:
        acts[act]()  # nothing that is left is in its way
    assert {one.name for one in site.load().members} == after


@pytest.mark.parametrize(
    "act",
    [
        lambda site: site.add("viewer", "new", RIG, (), by_password=True),
        lambda site: site.renew("guest"),
        lambda site: site.revoke("guest"),
        lambda site: site.revoke("shed"),
    ],
    ids=["add", "renew", "revoke", "revoke hub"],
)
def test_what_a_crash_left_old_of_other_hubs_is_put_right_by_what_is_done_next(
    site: SiteFolder, monkeypatch: pytest.MonkeyPatch, act: Callable[[SiteFolder], object]
) -> None:
    for name, passwords in (("barn", False), ("door", True), ("shed", False)):
        site.add_hub(name, HOSTS, passwords=passwords)
    site.add("viewer", "guest", RIG, (), by_password=True)
    whole = site.path.with_name("whole")
    shutil.copytree(site.path, whole)
    crashed, step = True, 0
    while crashed:
        shutil.rmtree(site.path)
        shutil.copytree(whole, site.path)
        with monkeypatch.context() as broken:
            crash_at(broken, step)
            try:
                act(site)
                crashed = False
            except CrashError:
                step += 1
        site.renew("hub")
        members = (site.hub / "members.json").read_bytes()
        there = site.load()
        for hub in there.hubs:
            assert (site.folder_of_hub(hub.name) / "members.json").read_bytes() == members
        users = (site.folder_of_hub("door") / "users").read_text().splitlines()
        assert users[0].startswith("nobody:")
        passwords = {
            one.common_name: (site.folder_of(one) / "password").read_text().strip()
            for one in there.members
        }
        assert dict(line.split(":") for line in users[1:]) == passwords
    assert step > 2


def crash_at(monkeypatch: pytest.MonkeyPatch, step: int) -> None:
    """End the process before its n-th change of what files are named."""
    left = [step]

    def counting(original: Callable[..., object]) -> Callable[..., object]:
        def change(*arguments: object, **named: object) -> object:
            if left[0] == 0:
                raise CrashError
            left[0] -= 1
            return original(*arguments, **named)

        return change

    for name in STEPS:
        monkeypatch.setattr(Path, name, counting(getattr(Path, name)))
    # What a process that is gone would not do either.
    monkeypatch.setattr(site_folder.shutil, "rmtree", counting(site_folder.shutil.rmtree))


def test_a_folder_that_is_no_site_is_one_line(tmp_path: Path, site: SiteFolder) -> None:
    with pytest.raises(SettingsError, match="inhand hub init"):
        SiteFolder(tmp_path / "nothing").add("camera", "front", RIG, ())
    (site.path / "authority" / "key.pem").write_text("nonsense")
    with pytest.raises(InhandError, match="get it back from a backup"):
        site.add("camera", "front", RIG, ())
    assert site.load().members == ()


@pytest.mark.parametrize("host", ["", "two words", "-a", "a..b", "http://hub", "hub:7448"])
def test_what_is_no_host_is_refused(tmp_path: Path, host: str) -> None:
    with pytest.raises(SettingsError, match="is no host"):
        create_site(tmp_path / "site", REALM, (RIG,), (host,))
    assert not (tmp_path / "site").exists()


def test_a_link_in_the_place_of_a_member_s_folder_is_not_followed(
    site: SiteFolder, tmp_path: Path
) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "kept").touch()
    (site.path / "members" / f"{RIG}.front").symlink_to(elsewhere)
    with pytest.raises(InhandError, match=r"cannot write .*symbolic link"):
        site.add("camera", "front", RIG, ())
    assert [one.name for one in elsewhere.iterdir()] == ["kept"]
    assert site.load().members == ()

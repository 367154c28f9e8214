"""The list of members as the hub reads it."""

import os
from pathlib import Path

import pytest
from inhand_hub.access import Member
from inhand_hub.members import (
    SiteMembers,
    encode_members,
    load_members,
    with_member,
    without_member,
)
from inhand_runtime.errors import SettingsError
from msgspec.structs import replace

FRONT = Member(name="front", rig="kitchen", role="camera", common_name="kitchen.front.1")
SITE = SiteMembers(realm="home", rigs=("kitchen",), hosts=("localhost",))
WITH_FRONT = with_member(SITE, FRONT, 1e9)


def test_what_is_written_is_read(tmp_path: Path) -> None:
    path = tmp_path / "members.json"
    path.write_bytes(encode_members(WITH_FRONT))
    assert load_members(path) == WITH_FRONT
    assert without_member(WITH_FRONT, FRONT) == SITE


@pytest.mark.parametrize(
    ("site", "words"),
    [
        (replace(WITH_FRONT, members=(FRONT, FRONT)), "'kitchen.front.1' stands there twice"),
        (
            with_member(WITH_FRONT, replace(FRONT, common_name="kitchen.front.2"), 1e9),
            "'kitchen/front' stands there twice",
        ),
        (replace(WITH_FRONT, rigs=("kitchen", "kitchen")), "'kitchen' stands there twice"),
        (replace(WITH_FRONT, rigs=("garage",)), "'kitchen' is no rig of the site"),
        (replace(WITH_FRONT, ends_at={}), "do not fit"),
        (with_member(SITE, replace(FRONT, name="front/**"), 1e9), "is no list of members"),
        (with_member(SITE, replace(FRONT, rig="*"), 1e9), "is no list of members"),
        (with_member(SITE, replace(FRONT, common_name=""), 1e9), "is no list of members"),
        (with_member(SITE, replace(FRONT, role="all"), 1e9), "is no list of members"),  # type: ignore[arg-type]
    ],
)
def test_a_list_that_contradicts_itself_or_names_patterns_is_refused(
    tmp_path: Path, site: SiteMembers, words: str
) -> None:
    path = tmp_path / "members.json"
    path.write_bytes(encode_members(site))
    with pytest.raises(SettingsError, match=words):
        load_members(path)


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ('"members"', '"denied": [], "members"', "unknown field `denied`.*update this host"),
        ('"name"', '"until": 1, "name"', "unknown field `until`.*update this host"),
        ('"members"', f'"x": {"[" * 5000}{"]" * 5000}, "members"', "unknown field `x`"),
    ],
    ids=["field", "member's field", "nested"],
)
def test_a_list_that_this_release_cannot_read_whole_is_refused(
    tmp_path: Path, before: str, after: str, words: str
) -> None:
    path = tmp_path / "members.json"
    path.write_text(encode_members(WITH_FRONT).decode().replace(before, after, 1))
    with pytest.raises(SettingsError, match=words):
        load_members(path)


def test_who_ends_soon_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("inhand_hub.members.time.time", lambda: 1e9 - 10 * 86_400.0)
    assert WITH_FRONT.ending(within_days=11) == [(FRONT, 10.0)]
    assert WITH_FRONT.ending(within_days=9) == []


def test_a_list_in_another_user_s_folder_says_whose_it_has_to_be(tmp_path: Path) -> None:
    folder = tmp_path / "hub"
    folder.mkdir(mode=0)
    user = os.geteuid()
    stranger = user or 990  # root may read everything
    os.seteuid(stranger)
    try:
        with pytest.raises(
            SettingsError, match=rf"Permission denied.* chown -R {stranger} \S+/hub$"
        ):
            load_members(folder / "members.json")
    finally:
        os.seteuid(user)
        folder.chmod(0o700)

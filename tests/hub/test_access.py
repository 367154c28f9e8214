"""What rules allow each member: its own, and nothing of anybody else."""

from collections.abc import Iterable

import pytest
from hypothesis import given
from hypothesis import strategies as st
from inhand_hub.access import (
    ROLES,
    Flow,
    Member,
    Operation,
    access_control,
    link_rules,
    rules_of,
)
from inhand_schemas.keys import Site, parse_key
from inhand_schemas.procedures import PROCEDURES
from inhand_schemas.topics import HEALTH, RGBD, SKELETONS, TOPICS

REALM = "home"
SITE = Site(REALM, "kitchen")
# Few, so that names of different members often are the same.
names = st.sampled_from(("a", "b", "ab", "a_b", "capture", "x1"))
members = st.builds(
    Member,
    name=names,
    rig=names,
    role=st.sampled_from(sorted(ROLES)),
    common_name=st.integers(0, 1 << 32).map("x.{}".format),
    objects=st.lists(names, max_size=3).map(tuple),
)
SENDING: tuple[Operation, ...] = ("put", "reply", "declare_queryable", "liveliness_token")
"""What others get of a member."""


def member(role: str, name: str = "it", objects: tuple[str, ...] = ()) -> Member:
    return Member(name=name, rig=SITE.rig, role=role, common_name=f"x.{name}", objects=objects)


def includes(pattern: str, key: str) -> bool:
    """Whether a key expression includes all that another stands for, as Zenoh defines it."""
    return _includes(pattern.split("/"), key.split("/"))


def _includes(pattern: list[str], key: list[str]) -> bool:
    if not pattern:
        return not key
    first, rest = pattern[0], pattern[1:]
    if first == "**":
        ends = next((i for i, chunk in enumerate(key) if chunk.startswith("@")), len(key))
        return any(_includes(rest, key[taken:]) for taken in range(ends + 1))
    if not key or (key[0] == "**"):
        return False
    fits = key[0] == first or (first == "*" and not key[0].startswith("@"))
    return fits and _includes(rest, key[1:])


def allowed(one: Member, flow: Flow, operation: Operation, key: str) -> bool:
    return any(
        rule.flow == flow and operation in rule.operations and includes(pattern, key)
        for rule in rules_of(one, REALM)
        for pattern in rule.keys
    )


def own_names(one: Member, stream: str) -> set[str]:
    """The names under which a member may publish a stream."""
    role = ROLES[one.role]
    if stream == HEALTH.stream:
        return set() if role.service is None else {one.name}
    if all(topic.stream != stream for topic in role.publishes):
        return set()
    return set(one.objects) if one.role == "tracker" else {one.name}


@given(members, names, names, st.sampled_from(sorted(TOPICS)))
def test_nobody_puts_on_a_key_that_is_not_its_own(
    one: Member, rig: str, name: str, stream: str
) -> None:
    key = Site(REALM, rig).key(stream, name)
    own = rig == one.rig and name in own_names(one, stream)
    assert allowed(one, "ingress", "put", key) == own


@given(members)
def test_what_others_get_of_a_member_is_on_keys_of_its_own(one: Member) -> None:
    for rule in rules_of(one, REALM):
        if rule.flow != "ingress" or not set(rule.operations) & set(SENDING):
            continue
        for key in rule.keys:
            chunks = key.split("/")
            assert chunks[:3] == [REALM, "@v1", one.rig]
            if chunks[3] == "@rpc":
                assert chunks[4] == ROLES[one.role].service
            elif chunks[3] in ("@live", "@claim"):
                assert chunks[4:6] == [ROLES[one.role].service, one.name]
            else:
                plain = key.removesuffix("/@adv/**")
                assert parse_key(plain).name in own_names(one, chunks[3])


@given(members)
def test_nothing_reaches_or_leaves_another_rig_or_realm(one: Member) -> None:
    for rule in rules_of(one, REALM):
        assert rule.keys
        for key in rule.keys:
            assert key.startswith(f"{REALM}/@v1/{one.rig}/")


@given(members)
def test_what_a_member_may_hear_it_may_ask_for_and_the_other_way_round(one: Member) -> None:
    rules = rules_of(one, REALM)
    site = Site(REALM, one.rig)
    for topic in TOPICS.values():
        asked = allowed(one, "ingress", "declare_subscriber", topic.pattern(site))
        heard = allowed(one, "egress", "put", topic.key(site, "any"))
        assert asked == heard
    assert not any("**" in key.split("/")[3] for rule in rules for key in rule.keys)


READS = {
    "camera": {"health"},
    "tracker": {"health", "info", "rgbd", "skeletons"},
    "recorder": set(TOPICS),
    "studio": set(TOPICS),
    "outcomes": {"health", "info", "pose", "rgbd", "skeletons"},
    "viewer": {"health", "info", "pose", "preview", "skeletons"},
}


@pytest.mark.parametrize("role", list(ROLES))
def test_a_role_reads_what_it_needs_and_no_more(role: str) -> None:
    one = member(role)
    read = {
        topic.stream
        for topic in TOPICS.values()
        if allowed(one, "egress", "put", topic.key(SITE, "any"))
    }
    assert read == READS[role]


@pytest.mark.parametrize("role", list(ROLES))
def test_only_the_studio_asks_procedures(role: str) -> None:
    asks = {
        one.verb
        for one in PROCEDURES
        if allowed(member(role), "ingress", "query", one.pattern(SITE))
    }
    assert asks == ({one.verb for one in PROCEDURES} if role == "studio" else set())


@pytest.mark.parametrize(
    "wildcard", ["**", "home/**", "home/@v1/**", "home/@v1/kitchen/**", "home/@v1/kitchen/*/*"]
)
@pytest.mark.parametrize("role", list(ROLES))
def test_nobody_subscribes_or_puts_by_wildcards_over_streams(role: str, wildcard: str) -> None:
    one = member(role, objects=("mug",))
    for operation in ("put", "declare_subscriber", "query", "declare_queryable"):
        assert not allowed(one, "ingress", operation, wildcard)


def test_a_camera_puts_by_no_wildcard_over_names() -> None:
    camera = member("camera")
    assert allowed(camera, "ingress", "put", RGBD.key(SITE, "it"))
    assert not allowed(camera, "ingress", "put", RGBD.pattern(SITE))
    assert not allowed(camera, "ingress", "put", SKELETONS.key(SITE, "it") + "/**")


def test_nothing_is_deleted_and_what_no_rule_names_is_denied() -> None:
    control = access_control(REALM, [member(role, role) for role in ROLES])
    assert control["enabled"] is True
    assert control["default_permission"] == "deny"
    assert all(rule["permission"] == "allow" for rule in control["rules"])
    assert not any("delete" in rule["messages"] for rule in control["rules"])


@given(st.lists(members, max_size=4, unique_by=lambda one: one.common_name))
def test_each_certificate_has_the_rules_of_its_own_member(several: list[Member]) -> None:
    control = access_control(REALM, several)
    ids = [rule["id"] for rule in control["rules"]]
    assert len(ids) == len(set(ids))
    used = [name for policy in control["policies"] for name in policy["rules"]]
    assert sorted(used) == sorted(ids)
    for one, subject, policy in zip(several, control["subjects"], control["policies"], strict=True):
        assert subject["cert_common_names"] == [one.common_name]
        assert policy["subjects"] == [subject["id"]]
        rules = [rule for rule in control["rules"] if rule["id"] in policy["rules"]]
        assert _keys(rules) == {key for rule in rules_of(one, REALM) for key in rule.keys}


@pytest.mark.parametrize("far", [False, True])
@given(members)
def test_all_that_a_member_may_passes_between_hubs_but_pictures_over_a_far_link(
    far: bool, one: Member
) -> None:
    passes = {key for rule in link_rules(REALM, (one.rig,), far=far) for key in rule.keys}
    site = Site(REALM, one.rig)
    stays = {site.access_key(ROLES[one.role].service or "viewer", one.name)}
    if far:
        stays |= {RGBD.pattern(site), *(RGBD.key(site, name) for name in (one.name, *one.objects))}
    for key in {key for rule in rules_of(one, REALM) for key in rule.keys}:
        assert any(includes(pattern, key) for pattern in passes) == (key not in stays), key


def test_nothing_of_another_site_passes_between_hubs() -> None:
    for rule in link_rules(REALM, ("kitchen", "garage"), far=False):
        for key in rule.keys:
            assert key.startswith((f"{REALM}/@v1/kitchen/", f"{REALM}/@v1/garage/"))
            assert "**" not in key.removesuffix("/@adv/**")


def _keys(rules: Iterable[dict[str, list[str]]]) -> set[str]:
    return {key for rule in rules for key in rule["key_exprs"]}


def test_the_inclusion_of_these_tests_is_zenoh_s() -> None:
    import zenoh

    expressions = [
        "home/@v1/kitchen/rgbd/front",
        "home/@v1/kitchen/rgbd/*",
        "home/@v1/kitchen/info/*/@adv/**",
        "home/@v1/kitchen/info/front/@adv/pub/x",
        "home/@v1/kitchen/@live/*/*",
        "home/@v1/kitchen/@live/capture/front",
        "home/@v1/kitchen/**",
        "home/**",
        "**",
    ]
    for pattern in expressions:
        for key in expressions:
            expected = zenoh.KeyExpr(pattern).includes(zenoh.KeyExpr(key))
            assert includes(pattern, key) == expected, (pattern, key)

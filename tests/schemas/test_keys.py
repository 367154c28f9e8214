"""Keys are built and parsed in one place, and wrong ones are told."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from inhand_schemas.errors import KeyFormatError, UnknownVersionError
from inhand_schemas.keys import ParsedKey, Site, beside, parse_claim, parse_key, parse_live_key
from inhand_schemas.topics import POSE, TOPICS, topic_of
from message_strategies import names


def test_a_key_is_realm_version_rig_stream_name() -> None:
    assert POSE.key(Site("home", "kitchen"), "mug") == "home/@v1/kitchen/pose/mug"


@given(realm=names, rig=names, stream=names, name=names)
def test_a_key_parses_to_what_it_was_built_from(
    realm: str, rig: str, stream: str, name: str
) -> None:
    site = Site(realm, rig)
    assert parse_key(site.key(stream, name)) == ParsedKey(site, stream, name)


@given(st.sampled_from(sorted(TOPICS)), names)
def test_a_topic_is_found_by_its_key(stream: str, name: str) -> None:
    topic = TOPICS[stream]
    assert topic_of(topic.key(Site(), name)) == (topic, ParsedKey(Site(), stream, name))


@given(st.text())
def test_any_text_is_a_key_or_a_key_error(text: str) -> None:
    try:
        parsed = parse_key(text)
    except KeyFormatError:
        return
    assert parsed.site.key(parsed.stream, parsed.name) == text


INVALID = ["", "Mug", "my mug", "a/b", "*", "**", "@v1", "mug\n", "größe", "a-b", "a" * 65, "$*"]


@pytest.mark.parametrize("name", INVALID)
def test_an_invalid_name_is_refused_everywhere(name: str) -> None:
    with pytest.raises(KeyFormatError, match="name"):
        POSE.key(Site(), name)
    with pytest.raises(KeyFormatError):
        Site(name, "rig")
    with pytest.raises(KeyFormatError):
        Site("inhand", name)
    with pytest.raises(KeyFormatError):
        Site().key(name, "mug")
    with pytest.raises(KeyFormatError):
        Site().live_key("tracker", name)
    with pytest.raises(KeyFormatError):
        Site().claim_key("tracker", "a", "up", name)
    with pytest.raises(KeyFormatError):
        parse_key(f"inhand/@v1/rig/pose/{name}")


@pytest.mark.parametrize(
    "key",
    ["", "mug", "inhand/rig/pose/mug", "inhand/v1/rig/pose/mug", "inhand/@v1/rig/pose/mug/more"],
)
def test_another_form_is_no_key(key: str) -> None:
    with pytest.raises(KeyFormatError, match=r"is no key|has no version"):
        parse_key(key)


def test_an_unknown_version_is_told() -> None:
    with pytest.raises(UnknownVersionError, match="version 2, and this release reads version 1"):
        parse_key("inhand/@v2/rig/pose/mug")
    with pytest.raises(UnknownVersionError):
        topic_of("inhand/@v0/rig/pose/mug")


def test_an_unknown_stream_is_told() -> None:
    with pytest.raises(KeyFormatError, match="no stream 'smell'"):
        topic_of("inhand/@v1/rig/smell/mug")


def test_patterns_cover_one_rig() -> None:
    site = Site("home", "kitchen")
    assert POSE.pattern(site) == "home/@v1/kitchen/pose/*"
    assert site.pattern() == "home/@v1/kitchen/*/*"
    assert site.live_key("tracker", "a") == "home/@v1/kitchen/@live/tracker/a"
    assert site.live_pattern() == "home/@v1/kitchen/@live/*/*"
    assert site.access_key("tracker", "a") == "home/@v1/kitchen/@access/tracker/a"
    assert site.access_pattern() == "home/@v1/kitchen/@access/*/*"
    assert beside(POSE.pattern(site)) == "home/@v1/kitchen/pose/*/@adv/**"


def test_a_liveliness_key_is_no_stream() -> None:
    with pytest.raises(KeyFormatError):
        parse_key(Site().live_key("tracker", "a"))


def test_a_liveliness_key_names_service_and_instance() -> None:
    assert parse_live_key(Site().live_key("tracker", "a")) == ("tracker", "a")


def test_a_claims_key_gives_the_claim_back() -> None:
    key = Site("home", "kitchen").claim_key("tracker", "a", "up", "17_ab")
    assert key == "home/@v1/kitchen/@claim/tracker/a/up/17_ab"
    assert parse_claim(key) == "17_ab"


@pytest.mark.parametrize("key", [Site().live_key("a", "b"), "a/@v1/r/@claim/a/b/up", "a/b"])
def test_another_form_is_no_claims_key(key: str) -> None:
    with pytest.raises(KeyFormatError, match="no key of a claim"):
        parse_claim(key)


@pytest.mark.parametrize(
    "key", ["inhand/@v1/rig/pose/mug", "inhand/@v1/rig/@live/tracker", "a/@v1/r/@live/Tracker/b"]
)
def test_another_key_is_of_no_instance(key: str) -> None:
    with pytest.raises(KeyFormatError):
        parse_live_key(key)


def test_another_versions_pattern_differs_in_the_version_only() -> None:
    assert Site("home", "kitchen").pattern_of_version(2) == "home/@v2/kitchen/*/*"

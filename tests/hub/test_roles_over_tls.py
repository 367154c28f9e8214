"""Members of each role at a hub that runs: who may do what, and what nobody gets to see."""

import contextlib

import pytest
import zenoh
from hub_site import (
    OTHER_RIG,
    PEOPLE,
    REALM,
    SITE,
    HubSite,
    listening,
    message_of,
    short_keys,
)
from inhand_runtime import session as runtime_session
from inhand_runtime import zenoh_config
from inhand_runtime.questions import answer, ask
from inhand_runtime.session import tokens, watch_tokens
from inhand_schemas.keys import Site
from inhand_schemas.procedures import PAUSE, PROCEDURES, RELOAD, SHUTTER
from inhand_schemas.topics import (
    EVENT,
    HEALTH,
    INFO,
    POSE,
    PREVIEW,
    RGBD,
    SKELETONS,
    TOPICS,
    AnyTopic,
)
from running_rig import eventually
from wire import Wire, lingering_s

pytestmark = pytest.mark.long

EVERYBODY = tuple(PEOPLE)
PERMITTED = {
    "front": {"info/front", "rgbd/front", "skeletons/front", "preview/front", "health/front"},
    "mug": {"pose/mug", "health/mug"},
    "disk": {"event/disk", "health/disk"},
    "desk": {"health/desk"},
    "anna": set[str](),
    "home": {"event/home", "health/home"},
}
"""Who may publish what, of all streams under all names of ``NAMES``."""
NAMES = ("front", "back", "mug", "disk", "desk", "anna", "home", "hub", "other")
WILDCARDS = ("**", "home/**", "home/@v1/**", "home/@v1/kitchen/**", "home/@v1/*/*/*", "*/@v1/*/**")


@pytest.mark.parametrize(
    ("publisher", "topic", "name", "readers"),
    [
        ("front", INFO, "front", {"mug", "disk", "desk", "anna", "home"}),
        ("front", RGBD, "front", {"mug", "disk", "desk", "home"}),
        ("front", SKELETONS, "front", {"mug", "disk", "desk", "anna", "home"}),
        ("front", PREVIEW, "front", {"disk", "desk", "anna"}),
        ("front", HEALTH, "front", {"back", "mug", "disk", "desk", "anna", "home"}),
        ("mug", POSE, "mug", {"disk", "desk", "anna", "home"}),
        ("home", EVENT, "home", {"disk", "desk"}),
    ],
    ids=lambda value: getattr(value, "stream", None),
)
def test_a_stream_reaches_the_roles_that_read_it_and_no_wildcard_of_another(
    wires: dict[str, Wire], publisher: str, topic: AnyTopic, name: str, readers: set[str]
) -> None:
    others = [one for one in EVERYBODY if one != publisher]
    heard = {one: wires[one].hear(topic) for one in others}
    eavesdropped = {one: listening(wires[one].session, *WILDCARDS) for one in others}
    outlet = wires[publisher].publisher(topic, name)

    def came() -> bool:
        outlet.put(message_of(topic))
        return all(len(heard[one]) >= (1 if topic is INFO else 5) for one in readers)

    eventually(f"{topic.stream} at {readers}", came)
    assert {one for one in others if heard[one]} == readers
    assert not any(eavesdropped[one][0] for one in set(others) - readers)


def test_a_member_s_link_is_closed_without_waiting_for_what_the_hub_has_not_taken(
    wires: dict[str, Wire],
) -> None:
    assert len(lingering_s()) >= len(wires)
    eventually("all close at once", lambda: not any(lingering_s()))


@pytest.mark.parametrize("attacker", list(PERMITTED))
def test_nobody_publishes_on_another_s_key(
    site: HubSite, wires: dict[str, Wire], attacker: str
) -> None:
    listener = wires["disk" if attacker == "desk" else "desk"]
    heard = {topic.stream: listener.hear(topic) for topic in TOPICS.values()}
    session = wires[attacker].session
    tokens(session, SITE.live_pattern())

    def put_everywhere() -> None:
        for topic in TOPICS.values():
            payload = topic.encode(message_of(topic))
            for name in NAMES:
                key = topic.key(SITE, name)
                session.put(key, payload, encoding=topic.encoding)
                session.put(session.declare_keyexpr(key), payload, encoding=topic.encoding)
                session.delete(key)
            for wildcard in (topic.pattern(SITE), f"home/@v1/**/{topic.stream}/front", "home/**"):
                session.put(wildcard, payload, encoding=topic.encoding)

    def came() -> bool:
        put_everywhere()
        tokens(session, SITE.live_pattern())  # went the same way, and is answered
        own = {key for samples in heard.values() for key in short_keys(samples)}
        return PERMITTED[attacker] <= own

    eventually("what is permitted", came)
    wires["back"].publisher(HEALTH, "back").put(message_of(HEALTH))
    eventually("permitted work", lambda: "health/back" in short_keys(heard["health"]))
    keys = {key for samples in heard.values() for key in short_keys(samples)}
    assert keys - {"health/hub", "health/back"} == PERMITTED[attacker]
    assert all(one.payload for samples in heard.values() for one in samples)


def test_only_the_studio_asks_and_only_who_is_asked_answers(wires: dict[str, Wire]) -> None:
    camera, tracker, studio, recorder = (wires[one] for one in ("front", "mug", "desk", "disk"))
    asked: list[bytes] = []

    def reply(request: bytes) -> bytes:
        asked.append(request)
        return b"true"

    kept = [
        answer(camera.session, SHUTTER.key(SITE, "front"), reply),
        answer(tracker.session, RELOAD.key(SITE, "mug"), reply),
        answer(recorder.session, PAUSE.key(SITE, "disk"), reply),
        answer(tracker.session, PAUSE.key(SITE, "disk"), lambda _: b"false"),
        answer(camera.session, RELOAD.key(SITE, "mug"), lambda _: b"false"),
        answer(camera.session, SHUTTER.key(SITE, "back"), lambda _: b"false"),
        answer(camera.session, SHUTTER.pattern(SITE), lambda _: b"false"),
        answer(recorder.session, SHUTTER.key(SITE, "front"), lambda _: b"false"),
        answer(recorder.session, f"{REALM}/@v1/**", lambda _: b"false"),
    ]
    for procedure, name in ((SHUTTER, "front"), (RELOAD, "mug"), (PAUSE, "disk")):
        key, pattern = procedure.key(SITE, name), procedure.pattern(SITE)
        eventually(key, lambda pattern=pattern: list(ask(studio.session, pattern, b"studio", 1.0)))
        assert set(ask(studio.session, pattern, b"studio", 1.0)) == {(key, b"true")}
    for name in ("back", "anna"):
        for procedure in PROCEDURES:
            assert not list(ask(wires[name].session, procedure.pattern(SITE), name.encode(), 0.5))
        assert not list(ask(wires[name].session, f"{REALM}/@v1/**", name.encode(), 0.5))
    assert set(asked) == {b"studio"}
    del kept


def test_nobody_lives_or_claims_under_another_s_name(wires: dict[str, Wire]) -> None:
    shown: set[str] = set()
    handle = watch_tokens(
        wires["desk"].session, SITE.live_pattern(), lambda key, lives: shown.add(key)
    )
    forged = [SITE.live_key("capture", "back"), SITE.live_key("hub", "hub2")]
    forged.append(SITE.claim_key("capture", "back", "up", "0"))
    own = SITE.live_key("capture", "front")
    with contextlib.ExitStack() as held:
        for key in (*forged, own):
            held.enter_context(runtime_session.shown(wires["front"].session, key))
        eventually("its own token", lambda: own in shown)
        assert not shown & set(forged)
        claims = SITE.claim_pattern("capture", "back")
        assert not tokens(wires["back"].session, claims)
    del handle


def test_a_kept_value_reaches_who_joins_late_though_it_was_sent_once(site: HubSite) -> None:
    with site.joined("front") as camera:
        publisher = camera.publisher(INFO, "front")  # its last value goes with it
        publisher.put(message_of(INFO))
        for name in ("mug", "disk", "desk", "anna"):
            with site.joined(name) as late:
                heard = late.hear(INFO)
                eventually(f"the kept value at {name}", lambda heard=heard: heard)
                assert INFO.decode(heard[0].payload, heard[0].encoding) == message_of(INFO)
        with site.joined("back") as other:
            keys, handles = listening(other.session, INFO.pattern(SITE), *WILDCARDS)
            replies = other.session.get(f"{INFO.key(SITE, 'front')}/@adv/**", timeout=0.5)
            assert not [reply for reply in replies if reply.ok is not None]
            assert not keys
            del handles


def test_a_member_of_another_rig_sees_nothing_of_this_one(site: HubSite) -> None:
    names = ("stranger", "front", "disk")
    with contextlib.ExitStack() as opened:
        stranger, camera, recorder = (opened.enter_context(site.joined(one)) for one in names)
        heard = recorder.hear(SKELETONS)
        keys, handles = listening(stranger.session, SKELETONS.pattern(SITE), *WILDCARDS)
        outlet = camera.publisher(SKELETONS, "front")

        def came() -> bool:
            outlet.put(message_of(SKELETONS))
            return len(heard) >= 5

        eventually("the recorder hears", came)
        assert not keys
        del handles


def test_each_rig_of_the_site_sees_the_hub_and_how_it_is(site: HubSite) -> None:
    garage = Site(REALM, OTHER_RIG)
    with site.joined("stranger") as stranger:
        keys, handles = listening(stranger.session, HEALTH.pattern(garage))
        eventually("the hub's health", lambda: HEALTH.key(garage, "hub") in keys)
        replies = stranger.session.liveliness().get(garage.live_pattern())
        assert {str(one.ok.key_expr) for one in replies if one.ok is not None} == {
            garage.live_key("hub", "hub")
        }
        del handles


@pytest.mark.parametrize("mode", ["peer", "router"])
def test_who_comes_as_a_peer_or_a_router_may_do_no_more(
    site: HubSite, wires: dict[str, Wire], mode: str
) -> None:
    given = site.settings("back").credentials
    assert given is not None
    tls = {
        "root_ca_certificate": str(given.authority),
        "connect_certificate": str(given.certificate),
        "connect_private_key": str(given.key),
        "enable_mtls": True,
    }
    config = zenoh_config.zenoh_config(
        {
            "mode": mode,
            "listen/endpoints": [],
            "connect/endpoints": [site.address],
            "transport/link/tls": tls,
        }
    )
    heard = {topic.stream: wires["desk"].hear(topic) for topic in TOPICS.values()}
    with zenoh.open(config) as attacker:
        keys, handles = listening(attacker, SKELETONS.pattern(SITE), RGBD.pattern(SITE), *WILDCARDS)
        eventually("its link", attacker.info.routers_zid)
        own = wires["front"].publisher(SKELETONS, "front")

        def came() -> bool:
            for topic in TOPICS.values():
                for name in NAMES:
                    payload = topic.encode(message_of(topic))
                    attacker.put(topic.key(SITE, name), payload, encoding=topic.encoding)
            own.put(message_of(SKELETONS))
            return {"skeletons/front", "skeletons/back"} <= short_keys(heard["skeletons"])

        eventually("what is permitted", came)
        del handles
    spoofed = {key for samples in heard.values() for key in short_keys(samples)}
    back = {f"{one}/back" for one in ("info", "rgbd", "skeletons", "preview", "health")}
    assert spoofed - {"health/hub", "skeletons/front"} <= back
    assert not keys

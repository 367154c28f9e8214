"""Two hubs of one site, on two hosts, and what passes between them."""

import contextlib
from collections.abc import Iterator

import pytest
from hub_site import (
    REALM,
    SITE,
    HubSite,
    linked_hub,
    listening,
    made_site,
    message_of,
    short_keys,
    start_hub,
)
from inhand_schemas.topics import INFO, POSE, PREVIEW, RGBD, SKELETONS, TOPICS
from running_rig import RunningRig, eventually


@pytest.fixture(scope="module", params=[False, True], ids=["near", "far"])
def linked(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[tuple[HubSite, HubSite, bool]]:
    """The first hub of a site, a further one, and whether the link between them is far."""
    folder = tmp_path_factory.mktemp("linked")
    with contextlib.closing(RunningRig(folder)) as rig:
        site = made_site(folder / "site")
        site.add_hub("garage", ("localhost", "127.0.0.1"), far=request.param)
        house = start_hub(rig, site)
        yield house, linked_hub(house, "garage"), request.param


def test_members_of_both_hubs_reach_each_other(linked: tuple[HubSite, HubSite, bool]) -> None:
    house, garage, far = linked
    with garage.joined("front") as camera, house.joined("desk") as desk:
        heard = {topic: desk.hear(topic) for topic in (INFO, SKELETONS, PREVIEW, RGBD)}
        outlets = {topic: camera.publisher(topic, "front") for topic in heard}

        def came() -> bool:
            for topic, outlet in outlets.items():
                outlet.put(message_of(topic))
            few = any(len(heard[topic]) < 1 for topic in (INFO, SKELETONS, PREVIEW))
            return not few and (far or bool(heard[RGBD]))

        eventually("what the camera publishes", came)
        assert bool(heard[RGBD]) != far
    with house.joined("mug") as tracker, garage.joined("anna") as viewer:
        poses = viewer.hear(POSE)
        outlet = tracker.publisher(POSE, "mug")

        def seen() -> bool:
            outlet.put(message_of(POSE))
            return bool(poses)

        eventually("the pose", seen)


def test_a_member_may_do_no_more_by_the_way_of_another_hub(
    linked: tuple[HubSite, HubSite, bool],
) -> None:
    house, garage, _ = linked
    with garage.joined("front") as camera, house.joined("desk") as desk:
        heard = {topic.stream: desk.hear(topic) for topic in TOPICS.values()}
        keys, handles = listening(camera.session, "**", f"{REALM}/@v1/**", SITE.pattern("pose"))

        def came() -> bool:
            for topic in TOPICS.values():
                for name in ("front", "back", "mug"):
                    payload = topic.encode(message_of(topic))
                    camera.session.put(topic.key(SITE, name), payload, encoding=topic.encoding)
            return bool(heard["skeletons"])

        eventually("its own skeletons", came)
        got = set[str]().union(*map(short_keys, heard.values()))
        published = {f"{stream}/front" for stream in ("info", "rgbd", "skeletons", "preview")}
        assert {key for key in got if not key.startswith("health/")} <= published
        assert "health/back" not in got
        assert not keys
        del handles


def test_instances_are_seen_over_the_link(linked: tuple[HubSite, HubSite, bool]) -> None:
    house, garage, _ = linked
    with house.joined("desk") as desk:
        eventually("both hubs", lambda: {"hub/hub", "hub/garage"} <= set(desk.live()))
    assert garage.hub.popen.poll() is None
    assert "no member" not in house.hub.stderr + garage.hub.stderr


def test_a_link_is_back_after_the_first_hub_was_away(
    linked: tuple[HubSite, HubSite, bool],
) -> None:
    house, garage, _ = linked
    with garage.joined("front") as camera:
        outlet = camera.publisher(SKELETONS, "front")
        house.hub.popen.kill()
        house.hub.wait()
        again = house.started_again()
        with again.joined("desk") as desk:
            heard = desk.hear(SKELETONS)

            def came() -> bool:
                outlet.put(message_of(SKELETONS))
                return bool(heard)

            eventually("skeletons over the new link", came)


def test_a_hub_that_was_revoked_is_linked_no_more(linked: tuple[HubSite, HubSite, bool]) -> None:
    house, garage, _ = linked
    with house.joined("desk") as desk:
        eventually("the garage", lambda: "hub/garage" in desk.live())
        house.folder.revoke("garage")
        eventually("the garage is gone", lambda: "hub/garage" not in desk.live())
        heard = desk.hear(SKELETONS)
        with garage.joined("back") as far, house.joined("front") as near:
            outlets = far.publisher(SKELETONS, "back"), near.publisher(SKELETONS, "front")

            def came() -> bool:
                for outlet in outlets:
                    outlet.put(message_of(SKELETONS))
                return len(heard) >= 20

            eventually("what is permitted", came)
    assert short_keys(heard) == {"skeletons/front"}

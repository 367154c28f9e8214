from inhand_tracker.people.following import PeopleWatched, PersonFollower
from inhand_tracker.people.parameters import DEFAULT_PEOPLE
from inhand_tracker.people.watching import CameraFrame, GivenObjects
from msgspec.structs import replace
from people import person

PATIENCE_NS = DEFAULT_PEOPLE.patience_ns


def test_the_nearest_person_whose_hips_are_seen_is_chosen_first() -> None:
    people = [person(1, 3.0), person(2, 1.0, missing=(0,)), person(3, 2.0)]
    follower = PersonFollower()
    assert follower.choose(people, 0) is people[2]
    assert follower.person_id == 3


def test_the_person_that_is_followed_stays_chosen_when_another_comes_nearer() -> None:
    follower = PersonFollower()
    follower.choose([person(2, 3.0)], 0)
    people = [person(1, 1.0), person(2, 3.0)]
    assert follower.choose(people, 1) is people[1]


def test_nobody_is_chosen_while_the_followed_person_is_away_for_less_than_two_seconds() -> None:
    follower = PersonFollower()
    follower.choose([person(2)], 0)
    assert follower.choose([person(1)], PATIENCE_NS - 1) is None
    assert follower.person_id == 2
    back = person(2)
    assert follower.choose([person(1), back], PATIENCE_NS) is back


def test_another_person_is_followed_after_two_seconds_without_the_first() -> None:
    follower = PersonFollower()
    follower.choose([person(2)], 0)
    other = person(1)
    assert follower.choose([other], PATIENCE_NS) is other
    assert follower.person_id == 1


def test_a_clock_that_jumps_back_does_not_hold_the_choice_for_ever() -> None:
    follower = PersonFollower()
    follower.choose([person(2)], 10 * PATIENCE_NS)
    other = person(1)
    assert follower.choose([other], 0) is other


def test_nobody_is_chosen_from_nobody() -> None:
    follower = PersonFollower()
    assert follower.choose([], 0) is None
    assert follower.choose([person(2, missing=(0,))], 1) is None


def test_where_hips_are_not_needed_the_nearest_chest_is_chosen() -> None:
    people = [person(1, 3.0), person(2, 1.0, missing=(0,)), person(3, 0.5, missing=(0, 2))]
    assert PersonFollower(needs_hips=False).choose(people, 0) is people[1]
    assert PersonFollower().choose(people, 0) is people[0]


def test_models_of_whole_bodies_say_which_joints_upper_bodies_lack_until_somebody_has_them() -> (
    None
):
    def see(needs_hips: bool, *missing: tuple[int, ...]) -> str | None:
        watched = PeopleWatched(lambda: GivenObjects({}, needs_hips=needs_hips), most=1)
        for joints in missing:
            watched.see([person(1, missing=joints)], CameraFrame(0), lambda *_: None)
        return watched.hips_trouble

    pelvis = (0, 1, 12, 16)
    assert "without HipCenter, Spine, HipLeft, HipRight" in str(see(True, pelvis))
    assert see(True) is None
    assert see(True, pelvis, (), (0,)) is None
    assert see(False, pelvis) is None


def test_a_skeleton_that_is_all_zero_is_nobody_to_follow() -> None:
    zeros = replace(person(1), joints=((0.0, 0.0, 0.0),) * 20)
    follower = PersonFollower()
    assert follower.choose([zeros], 0) is None
    other = person(2, 3.0)
    assert follower.choose([zeros, other], 1) is other

"""A face that is not found any more stays hidden for a while."""

from inhand_capture.faces.discs import Disc
from inhand_capture.faces.holding import HeldHeads
from inhand_capture.faces.parameters import DEFAULT_FACES

FRAME_NS = 33_333_333
HERE, THERE = Disc(100.0, 80.0, 20.0), Disc(400.0, 80.0, 30.0)


def _hides(discs: list[Disc], place: Disc) -> bool:
    return any(disc.distance(place) < disc.radius for disc in discs)


def _seen_often(heads: HeldHeads, *discs: Disc, pictures: int = 10) -> int:
    """Let discs be found again and again; returns the time of the next picture."""
    for number in range(pictures):
        heads.see([discs], number * FRAME_NS)
    return pictures * FRAME_NS


def test_a_face_that_is_not_found_stays_hidden_and_then_no_longer() -> None:
    heads = HeldHeads()
    time_ns = _seen_often(heads, HERE)
    last_ns = time_ns - FRAME_NS + round(1e9 * DEFAULT_FACES.held_s)
    while time_ns <= last_ns:
        assert _hides(heads.see([[]], time_ns), HERE)
        time_ns += FRAME_NS
    assert heads.see([[]], time_ns) == []


def test_what_is_hidden_grows_meanwhile_since_the_head_may_move() -> None:
    heads = HeldHeads()
    time_ns = _seen_often(heads, HERE)
    radii = [heads.see([[]], time_ns + number * FRAME_NS)[0].radius for number in range(10)]
    assert radii == sorted(radii)
    assert radii[-1] > 1.2 * HERE.radius


def test_what_was_found_once_does_not_grow() -> None:
    heads = HeldHeads()
    heads.see([[HERE]], 0)
    assert heads.see([[]], FRAME_NS) == [HERE]


def test_a_head_that_moves_is_hidden_where_it_is_and_leaves_no_trail() -> None:
    heads = HeldHeads()
    _seen_often(heads, HERE)
    moved = Disc(HERE.x + 15.0, HERE.y, HERE.radius)
    assert heads.see([[moved]], 10 * FRAME_NS) == [moved]


def test_of_two_heads_that_touch_the_lost_one_stays_hidden() -> None:
    heads = HeldHeads()
    beside = Disc(HERE.x + 12.0, HERE.y, HERE.radius)
    time_ns = _seen_often(heads, HERE, beside)
    for number in range(20):
        discs = heads.see([[beside]], time_ns + number * FRAME_NS)
        assert _hides(discs, HERE)
        assert len(discs) == 2


def test_finders_that_see_one_head_hide_the_places_of_all_of_them() -> None:
    heads = HeldHeads()
    near = Disc(HERE.x + 5.0, HERE.y, 25.0)
    assert set(heads.see([[HERE], [near, THERE]], 0)) == {HERE, near, THERE}
    assert heads.see([[], [THERE]], FRAME_NS)[-2:] == [HERE, near]


def test_a_clock_that_is_set_back_neither_reveals_a_face_nor_hides_it_for_ever() -> None:
    heads = HeldHeads()
    heads.see([[HERE]], 10**15)
    assert heads.see([[]], 5) == [HERE]
    assert heads.see([[]], 5 + round(1e9 * DEFAULT_FACES.held_s) + 1) == []

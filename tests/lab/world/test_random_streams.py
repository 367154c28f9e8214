"""Random streams of a simulated world."""

from inhand_lab.world.random_streams import random_stream


def test_every_purpose_has_a_stream_of_its_own_that_comes_again() -> None:
    purposes = [("motion", 0), ("motion", 1), ("camera",)]
    first, again = (
        [random_stream(1, 2, "drinkFromMug", *purpose).random() for purpose in purposes]
        for _ in range(2)
    )
    assert first == again
    assert len(set(first)) == 3

"""What is news of what is missing."""

from inhand_lab.new_recordings.parameters import DEFAULT_VIEW as VIEW
from inhand_lab.new_recordings.view_watch import ViewWatch
from inhand_schemas.messages import CameraInfo, RgbdFrame, Skeletons

INFO = CameraInfo(
    sequence=0, time_ns=0, width=640, height=480, fx=525.0, fy=525.0, cx=319.5, cy=239.5
)


def _kinds(lacks: object) -> list[str]:
    return [one.kind for one in lacks]  # type: ignore[attr-defined]


def test_what_lasts_is_said_once_when_it_begins_and_once_when_it_ends() -> None:
    watch = ViewWatch(0.0)
    watch.note(INFO, 0.0)
    said = []
    for step in range(40):
        now = 0.1 * step
        people = () if step < 20 else None
        if people is not None:
            watch.note(Skeletons(sequence=step, time_ns=0, people=people), now)
        watch.note(RgbdFrame(sequence=step, time_ns=0), now)
        begun, ended = watch.news(now)
        said += [(round(now, 1), kind, "begun") for kind in _kinds(begun)]
        said += [(round(now, 1), kind, "ended") for kind in _kinds(ended)]
    begins = [(kind, what) for _, kind, what in said if kind in ("person", "skeleton")]
    assert begins == [("person", "begun"), ("skeleton", "begun"), ("person", "ended")]
    assert said[0][0] >= VIEW.lasting_s


def test_what_flickers_is_no_news() -> None:
    watch = ViewWatch(0.0)
    watch.note(INFO, 0.0)
    for step in range(40):
        now = 0.1 * step
        watch.note(RgbdFrame(sequence=step, time_ns=0), now)
        if step % 5:
            continue
        assert "skeleton" not in _kinds(watch.news(now)[0])
        watch.note(Skeletons(sequence=step, time_ns=0), now)


def test_a_camera_that_falls_silent_is_missed_and_gaps_in_its_numbers_are_counted() -> None:
    watch = ViewWatch(0.0)
    for sequence in (0, 1, 4, 5, 2):
        watch.note(RgbdFrame(sequence=sequence, time_ns=0), 0.0)
    assert (watch.frames, watch.lost) == (5, 2)
    watch.news(VIEW.silent_s + 0.1)
    watch.news(VIEW.silent_s + 0.1 + VIEW.lasting_s)
    assert "camera" in _kinds(watch.missing)

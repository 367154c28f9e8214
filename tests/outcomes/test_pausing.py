"""What is wanted of measuring is done by the loop, and remembered."""

import threading
from pathlib import Path

import pytest
from inhand_outcomes import pausing as module
from inhand_outcomes.pausing import NOT_KEPT, Pausing
from inhand_outcomes.store.forgetting import Forget, forget
from inhand_schemas.procedures import OutcomesRequest
from kept_outcomes import at, new_saver

ALL = OutcomesRequest()


def test_a_pause_stays_over_restarts_and_when_all_is_forgotten(tmp_path: Path) -> None:
    database = new_saver(tmp_path).database
    pausing = Pausing()
    pausing.want(paused=True)
    assert pausing.take_wanted()
    pausing.keep(database)
    forget(database, Forget(everything=True), at("2026-05-05 12:00"))
    again = Pausing()
    again.keep(database)
    assert again.paused
    again.want(paused=True)
    assert not again.take_wanted()  # it is so already
    again.want(paused=False)
    assert again.take_wanted()
    again.keep(database)
    last = Pausing()
    last.keep(database)
    assert not last.paused
    database.close()


def test_who_asks_hears_when_it_is_remembered_and_of_another_instance_nothing(
    tmp_path: Path,
) -> None:
    database = new_saver(tmp_path).database
    pausing, end = Pausing(), threading.Event()

    def serve() -> None:
        while not end.wait(0.001):
            pausing.take_wanted()
            pausing.keep(database)

    thread = threading.Thread(target=serve)
    thread.start()
    for paused in (True, True, False):
        reply = pausing.ask("home", ALL, paused=paused)
        assert reply is not None
        assert (reply.outcomes, reply.paused, reply.problem) == ("home", paused, None)
    assert pausing.ask("home", OutcomesRequest(outcomes="shed"), paused=True) is None
    end.set()
    thread.join()
    assert not pausing.paused
    database.close()


def test_a_pause_that_no_database_takes_is_said_to_be_lost_with_a_restart(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "PATIENCE_S", 0.01)
    reply = Pausing().ask("home", ALL, paused=True)
    assert reply is not None
    assert (reply.paused, reply.problem) == (True, NOT_KEPT)

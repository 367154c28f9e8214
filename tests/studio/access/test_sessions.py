"""How long a browser is known."""

from inhand_studio.access.parameters import DEFAULT_GATE as GATE
from inhand_studio.access.sessions import Sessions


def test_a_browser_is_known_until_its_session_is_old_and_no_guess_is() -> None:
    now = [0.0]
    sessions = Sessions(clock=lambda: now[0])
    token = sessions.begin()
    assert sessions.knows(token)
    assert not sessions.knows(token[:-1])
    assert not sessions.knows(None)
    now[0] = GATE.session_s
    assert not sessions.knows(token)


def test_for_a_browser_too_many_the_oldest_is_forgotten() -> None:
    sessions = Sessions(clock=lambda: 0.0)
    tokens = [sessions.begin() for _ in range(GATE.most_sessions + 1)]
    assert not sessions.knows(tokens[0])
    assert all(sessions.knows(token) for token in tokens[1:])

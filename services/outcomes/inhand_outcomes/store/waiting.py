"""Keeps in memory what a database does not take at once, and tries again."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from inhand_runtime.errors import InhandError

from inhand_outcomes.outcome import Outcome
from inhand_outcomes.store.owning import TakenError
from inhand_outcomes.store.parameters import DEFAULT_WAITING, WaitingParameters
from inhand_outcomes.store.saving import Saved, Saver


@dataclass
class WaitingOutcomes:
    """Outcomes, and the newest journal, that wait until a database takes them, in order.

    ``opened`` opens the database, or raises InhandError; it is called again after each failure.
    """

    opened: Callable[[], Saver]
    parameters: WaitingParameters = DEFAULT_WAITING
    problem: str | None = None
    """Why the database takes nothing now, in a line."""
    lost: int = 0
    """Number of outcomes that did not fit into memory: the oldest went."""
    _waiting: list[Outcome] = field(default_factory=list)
    _journal: dict[str, bytes | None] = field(default_factory=dict)
    _saver: Saver | None = None
    _failures: int = 0
    _next_try_s: float = float("-inf")

    @property
    def waiting(self) -> int:
        """Number of outcomes that wait."""
        return len(self._waiting)

    @property
    def saver(self) -> Saver | None:
        """The open database, None while it takes nothing."""
        return self._saver

    def begin(self, now_s: float) -> None:
        """Open the database, if it can be opened now; raises TakenError where another owns it."""
        try:
            self._saver = self.opened()
        except TakenError:
            raise
        except InhandError as error:
            self._fail(str(error), now_s)

    def save(
        self,
        outcomes: Sequence[Outcome],
        journal: Mapping[str, bytes | None],
        now_s: float,
    ) -> Saved | None:
        """Take outcomes and entries of the journal, and save all that waits.

        ``now_s`` is of a clock that only goes on. Returns None where the database took nothing:
        ``problem`` says why, and it is tried again after a while, in a later call.
        """
        self._waiting += outcomes
        self._journal |= journal
        too_many = max(len(self._waiting) - self.parameters.most, 0)
        self.lost += too_many
        del self._waiting[:too_many]
        if now_s < self._next_try_s:
            return None
        try:
            if self._saver is None:
                self._saver = self.opened()
            saved = self._saver.save(self._waiting, self._journal)
        except InhandError as error:
            self._fail(str(error), now_s)
            return None
        self._waiting, self._journal = [], {}
        self.problem, self._failures, self._next_try_s = None, 0, float("-inf")
        return saved

    def close(self) -> None:
        """Close the database; what waits still is gone with the process."""
        if self._saver is not None:
            self._saver.database.close()
            self._saver = None

    def _fail(self, problem: str, now_s: float) -> None:
        self.problem = problem
        wait_s = self.parameters.first_wait_s * 2.0 ** min(self._failures, 30)
        self._failures += 1
        self._next_try_s = now_s + min(wait_s, self.parameters.longest_wait_s)
        self.close()

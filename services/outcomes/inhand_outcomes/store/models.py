"""The tables, as types."""

from datetime import date
from typing import Any

from sqlalchemy import JSON, BigInteger, ForeignKey, Index, LargeBinary, MetaData, text
from sqlalchemy.orm import DeclarativeBase, Mapped, mapped_column, relationship

NOBODY = -1
"""Number of the person in the tables where an object was in nobody's hands."""


class Base(DeclarativeBase):
    """What all tables share: names of constraints that a later migration can name."""

    metadata = MetaData(
        naming_convention={
            "ix": "ix_%(column_0_label)s",
            "uq": "uq_%(table_name)s_%(column_0_name)s",
            "fk": "fk_%(table_name)s_%(column_0_name)s_%(referred_table_name)s",
            "pk": "pk_%(table_name)s",
        }
    )
    type_annotation_map = {int: BigInteger()}


class OutcomeRow(Base):
    """One outcome in detail; ``day`` is the local date of its end, ``pose`` x y z, w x y z, and
    ``published`` whether its event went out."""

    __tablename__ = "outcomes"
    __table_args__ = (
        Index("ix_outcomes_act", "object", "kind", "person", "end_ns"),
        Index("ix_outcomes_day", "day"),
        Index(
            "ix_outcomes_published",
            "published",
            sqlite_where=text("published = 0"),
            postgresql_where=text("NOT published"),
        ),
    )

    id: Mapped[str] = mapped_column(primary_key=True)
    kind: Mapped[str]
    object: Mapped[str]
    person: Mapped[int]
    start_ns: Mapped[int]
    end_ns: Mapped[int]
    day: Mapped[date]
    probability: Mapped[float]
    counted: Mapped[bool]
    pose: Mapped[list[float] | None] = mapped_column(JSON(none_as_null=True))
    evidence: Mapped[dict[str, Any] | None] = mapped_column(JSON(none_as_null=True))
    first_sequence: Mapped[int | None]
    last_sequence: Mapped[int | None]
    published: Mapped[bool]
    amounts: Mapped[list["AmountRow"]] = relationship(
        cascade="all, delete-orphan", passive_deletes=True, lazy="selectin"
    )


class AmountRow(Base):
    """One amount of an outcome."""

    __tablename__ = "amounts"

    outcome: Mapped[str] = mapped_column(
        ForeignKey("outcomes.id", ondelete="CASCADE"), primary_key=True
    )
    name: Mapped[str] = mapped_column(primary_key=True)
    value: Mapped[float]
    deviation: Mapped[float]


class TotalRow(Base):
    """What was done on a day: how often, and for how many seconds in all.

    It stays when the outcomes that it sums up are removed for their age. Where ``counted`` is
    false it sums up those that were too uncertain to count.
    """

    __tablename__ = "totals"

    day: Mapped[date] = mapped_column(primary_key=True)
    kind: Mapped[str] = mapped_column(primary_key=True)
    object: Mapped[str] = mapped_column(primary_key=True)
    person: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    counted: Mapped[bool] = mapped_column(primary_key=True)
    times: Mapped[int]
    seconds: Mapped[float]


class TotalAmountRow(Base):
    """One amount of a day's total: its sum over ``times`` outcomes that have it, the sum's
    variance, and the largest value."""

    __tablename__ = "total_amounts"

    day: Mapped[date] = mapped_column(primary_key=True)
    kind: Mapped[str] = mapped_column(primary_key=True)
    object: Mapped[str] = mapped_column(primary_key=True)
    person: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    counted: Mapped[bool] = mapped_column(primary_key=True)
    name: Mapped[str] = mapped_column(primary_key=True)
    times: Mapped[int]
    sum: Mapped[float]
    variance: Mapped[float]
    largest: Mapped[float]


class PlaceRow(Base):
    """Where an object was when an outcome said so last, and whose hands it was in."""

    __tablename__ = "places"

    object: Mapped[str] = mapped_column(primary_key=True)
    time_ns: Mapped[int]
    day: Mapped[date]
    kind: Mapped[str]
    person: Mapped[int]
    pose: Mapped[list[float]] = mapped_column(JSON)


class JournalRow(Base):
    """What the daemon needs to go on where it was, by names of its own."""

    __tablename__ = "journal"

    name: Mapped[str] = mapped_column(primary_key=True)
    value: Mapped[bytes] = mapped_column(LargeBinary)


class GoalMarkRow(Base):
    """What is known of a goal in a period, from its first day to its last: see ``rules``.

    ``event`` is the message that says so, null where there is none, and ``published`` whether it
    went out. ``person`` is whose goal it is, ``NOBODY`` where it is of all.
    """

    __tablename__ = "goal_marks"

    goal: Mapped[str] = mapped_column(primary_key=True)
    period: Mapped[date] = mapped_column(primary_key=True)
    mark: Mapped[str] = mapped_column(primary_key=True)
    last_day: Mapped[date]
    person: Mapped[int]
    event: Mapped[dict[str, Any] | None] = mapped_column(JSON(none_as_null=True))
    published: Mapped[bool]


class FloorMapRow(Base):
    """The map of what was swept of the floor on a day: see ``floor_maps``."""

    __tablename__ = "floor_maps"

    day: Mapped[date] = mapped_column(primary_key=True)
    object: Mapped[str] = mapped_column(primary_key=True)
    person: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    header: Mapped[dict[str, Any]] = mapped_column(JSON)
    cells: Mapped[bytes] = mapped_column(LargeBinary)


class ForgottenRow(Base):
    """That something was forgotten: all, a person or a day. A daemon that runs meanwhile learns
    from it what it must not bring back from its memory."""

    __tablename__ = "forgotten"

    number: Mapped[int] = mapped_column(primary_key=True, autoincrement=False)
    time_ns: Mapped[int]
    person: Mapped[int | None]
    day: Mapped[date | None]

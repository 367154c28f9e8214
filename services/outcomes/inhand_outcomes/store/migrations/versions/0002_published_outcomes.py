"""Whether each outcome was published: what was kept before was."""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"


def upgrade() -> None:
    """Add it, with an index of the few that were not."""
    op.add_column(
        "outcomes", sa.Column("published", sa.Boolean(), nullable=False, server_default=sa.true())
    )
    op.create_index(
        "ix_outcomes_published",
        "outcomes",
        ["published"],
        unique=False,
        sqlite_where=sa.text("published = 0"),
        postgresql_where=sa.text("NOT published"),
    )

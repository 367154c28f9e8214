"""What alembic runs for each migration: all steps in the transaction of the connection given."""

from alembic import context

from inhand_outcomes.store.models import Base

# SQLite takes changes of tables back with their transaction, which alembic does not count on.
context.configure(
    connection=context.config.attributes["connection"],
    target_metadata=Base.metadata,
    transactional_ddl=True,
    render_as_batch=True,
)
with context.begin_transaction():
    context.run_migrations()

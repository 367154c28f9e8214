"""Where outcomes are kept: a database of SQLite or PostgreSQL, migrated when it is opened.

``database`` opens it and says what fails in one line, ``saving`` adds what is settled with the
daemon's journal, ``waiting`` keeps what a database does not take at once, ``queries`` answers,
``goal_marks`` remembers what was said of goals, ``retention`` removes what is old and
``forgetting`` what nobody shall know.
"""

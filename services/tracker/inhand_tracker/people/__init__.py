"""Who is seen: each person is followed, identified and given a watcher of objects."""

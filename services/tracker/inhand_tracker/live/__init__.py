"""What keeps a live tracker on time: which moment is next, and how much work it is worth."""

"""New training recordings: what is missing while one is made, and who uses what in it."""

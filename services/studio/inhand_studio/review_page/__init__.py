"""Review: a recording with what is true in it, what was tracked, and how far both are apart."""

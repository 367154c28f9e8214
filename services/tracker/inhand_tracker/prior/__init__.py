"""Where an object is, from the body alone."""

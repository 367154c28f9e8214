"""Measures of interactions: what was achieved, from an object's track. One file a family."""

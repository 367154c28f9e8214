"""Recorded bodies that use simulated objects."""

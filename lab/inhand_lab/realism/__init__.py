"""Compares the simulated sensors with real ones."""

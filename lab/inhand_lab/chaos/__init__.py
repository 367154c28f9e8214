"""Faults that are inflicted on a running rig, and what they cost it."""

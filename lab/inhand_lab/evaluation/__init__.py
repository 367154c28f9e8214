"""Trackers against the truth, on people left out of training."""

"""Cameras calibrated by a ChArUco board that two or more of them see at the same time."""

"""The laboratory: simulated people and cameras, datasets and evaluation.

Nothing here is needed by a daemon at run time, but for the simulator as a camera source.
"""

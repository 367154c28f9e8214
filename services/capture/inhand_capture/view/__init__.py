"""How a source's moments are seen by everybody else: upright, and with its masks burned in.

``viewed_source.py`` wraps any source; ``turning.py`` turns pictures, lenses, skeletons and labels
by quarters, ``masks.py`` makes polygons masks. ``private_memory.py`` keeps what is masked out of
core dumps.
"""

"""Records what crosses the wire, and looks after the files.

``losses`` counts what is missing, ``scanning`` walks files in any state, and on it stand
``inspection`` (what is in a file), ``verification`` (is all of it true) and ``recovery`` (a whole
file from a cut or damaged one).
"""

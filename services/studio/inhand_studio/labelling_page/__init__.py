"""The labelling page: a person sets an object's pose in some frames, and sees those between.

``page`` puts it together, ``panel`` has its controls and ``keys`` its keys, ``stage`` draws.
``editing``, ``placing``, ``shown_pose``, ``claim``, ``autosave``, ``opened`` and ``export`` know
nothing of a browser.
"""

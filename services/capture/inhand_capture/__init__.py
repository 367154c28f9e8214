"""The capture daemon: a camera, a recording or a simulated world onto Inhand's keys.

``service.py`` runs it, ``publishing.py`` turns moments into messages, ``reopening.py`` opens a
lost device again. ``replay.py`` is the source that plays a recording, whose messages
``moments.py`` puts together again. ``estimation`` finds skeletons in pictures.
"""

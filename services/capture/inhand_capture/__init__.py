"""The capture daemon: a camera, a recording or a simulated world onto Inhand's keys.

``service.py`` runs it by its ``settings.py``, ``publishing.py`` turns moments into messages,
``preview.py`` makes small ones for people who look, ``reopening.py`` opens a lost device again, and
``watching.py`` says in the health how it is. ``view`` turns and masks what any source gives,
``estimation`` finds skeletons in pictures, ``faces`` what to hide of them, and ``shutter.py`` stops
everything.
``sources/oak`` is the driver of a camera. ``sources/replay.py`` plays recordings:
``replay_files.py`` finds what is in them, ``moments.py`` puts their messages together again, and
``replay_playback.py`` pauses and seeks.
"""

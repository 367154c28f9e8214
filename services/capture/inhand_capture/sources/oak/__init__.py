"""The source ``oak``: a camera of the OAK family through depthai (extra ``oak``).

``source.py`` is the source. It opens a ``connection.py`` (the device and its graph, chosen among
those that ``devices.py`` finds), pairs what its two queues give (``pairing.py``), and makes moments
of it (``images.py``, ``clock.py``). ``controls.py`` is exposure, focus and light; ``condition.py``
says what is wrong with a camera that still gives pictures.
"""

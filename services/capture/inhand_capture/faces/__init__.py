"""Where faces are in pictures, so that they can be burned out before anything leaves the process.

``finder.py`` says what to hide of each picture: faces that ``face_detector.py`` finds, heads of the
bodies that a pose network finds (``heads.py``), and both for a while after they were seen last
(``holding.py``).
"""

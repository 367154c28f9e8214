"""Recordings without faces, or without people.

``looking.py`` finds people in all pictures of a camera, ``bodies.py`` says what of a picture
somebody takes, ``background.py`` what stands behind people, ``hiding.py`` what to hide of each
picture, and ``redacted.py`` is a recording as it is then.
"""

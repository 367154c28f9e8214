"""Cameras calibrated without a board: by the skeletons of a person who walks about for a minute.

``calibrate_from_people`` (``calibration``) finds where cameras are and how far their clocks are
apart; ``find_disagreement`` (``disagreement``) says later whether that still holds. Both take each
camera's ``CameraSkeletons`` (``skeletons``). How it is done, in order:

1. ``tracks``: each camera's people become smooth movements on the camera's own clock.
2. ``common_movement``: for two cameras, the clock offsets and poses at which movements agree best.
3. ``agreement``: at which moments two cameras see the same person, which of its sides is which.
4. ``refinement``: all poses, clocks and biases together by robust least squares, with covariance.
5. ``standing_floor``: the floor from feet that rest on it, and up from people who walk upright.
"""

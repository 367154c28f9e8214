"""Cameras calibrated by a ChArUco board that two or more of them see at the same time.

In order: ``board`` says what is drawn, ``sheet`` prints it, ``detection`` finds it in a picture,
``collecting`` gathers what cameras see, ``sights`` is that of one camera, ``alignment`` lays two
cameras' sights on each other, ``moments`` brings all together, ``adjustment`` finds what explains
them best, ``rig`` does all that, ``rig_frame`` chooses the frame (``depth_floor``), ``intrinsics``
looks at a lens alone, and ``calibration`` says what came of it. ``disagreement`` compares later.
"""

"""Where the cameras of a rig are: their poses in one frame, and how far their clocks are apart.

Two ways lead there: a printed board that several cameras see (``from_board``), and a person who
walks about (``from_people``). Both are functions on arrays; what reads recordings and sessions is
the command line's. The result is an ``inhand_runtime.rig_calibration.RigCalibration``.
"""

"""The figures that Darby, Li and Costen 2014 report, to stand beside ours (sections 6.2 and 7)."""

REFERENCE_METHOD = "gd-stable-proximate"

VERTEX_ERROR_CM = {
    "g-hand": 22.1,
    "gd-hand": 17.0,
    "gd-random": 16.0,
    "gd-stable": 14.1,
    "gd-stable-proximate": 12.6,
}
"""Table 1: means over 15 interactions by six unseen participants."""

EDGE_WORTH_PERCENT = {"drinkFromMug": 7.8, "putOnGlasses": 5.2, "sweepFloor": -4.3}
"""Percentage by which the edge likelihood reduced errors, where the text names it."""

MEAN_EDGE_WORTH_PERCENT = 2.1

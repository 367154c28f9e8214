"""Objects from nothing: from a mesh file, from a few measures, or measured by a camera.

Each way ends in an ``ObjectShape`` with marks, a mirror plane and symmetries (``proposal``), and in
``objects/NAME/`` of a dataset (``object_folder``); ``picture`` shows it beside a hand.
"""

"""The studio: pages in the browser to watch a rig, teach it objects, and look at recordings.

``service`` runs it, ``server`` serves pages, ``visit`` is one browser tab, and ``pages`` lists what
a tab can show; each page is a package of its own.
"""

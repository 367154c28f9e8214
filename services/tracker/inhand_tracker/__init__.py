"""Object poses from body poses and images.

``learn`` turns labelled sequences into a ``Mapping``, ``save_model`` keeps it with the object's
shape, and a ``Tracker`` follows the object: ``tracker.step(joints, image)`` gives an ``Estimate``
a frame. The method is that of Darby et al. (CVIU 2014); arrays only, no Zenoh outside
``service``.
"""

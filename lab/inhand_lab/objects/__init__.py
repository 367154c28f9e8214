"""The things in people's hands, modelled at real size, one a file.

Every object's frame has the plane x = 0 as the object's own mirror plane, so that left-handed use
is right-handed use reflected.
"""

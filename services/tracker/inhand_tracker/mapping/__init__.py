"""The published mapping from body poses to object poses (Darby et al. 2014)."""

"""The published methods of Darby et al. 2014."""

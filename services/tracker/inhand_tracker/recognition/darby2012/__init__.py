"""The published cascade of Darby et al. 2012, to compare with."""

"""The published cascade of Darby et al. 2012, which ours is compared with."""

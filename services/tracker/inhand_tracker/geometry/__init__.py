"""Rotations, cameras, images and estimates: arrays that know no body and no object."""

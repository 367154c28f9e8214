"""Compiled algebra of rotations and small matrices, which all other kernels share."""

"""Compiled code of the prior: kernels of regressions, and the combination of predictions."""

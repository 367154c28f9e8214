"""Compiled parts of joining what several cameras see: arrays in, arrays out."""

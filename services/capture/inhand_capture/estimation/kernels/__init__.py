"""Compiled code of skeleton estimation: arrays in, arrays out."""

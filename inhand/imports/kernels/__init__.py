"""Compiled code of the imports: arrays in, arrays out."""

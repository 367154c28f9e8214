"""Compiled code of shapes: arrays in, arrays out. The tests hold a plain definition of each."""

"""Compiled code of sight: arrays in, arrays out. The tests hold a plain definition of each."""

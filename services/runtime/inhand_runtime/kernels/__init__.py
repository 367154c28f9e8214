"""Compiled code that several services share: arrays in, arrays out."""

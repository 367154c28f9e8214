"""Compiled code of bodies: joints in, coordinate systems and descriptions out."""

"""Evaluates how well objects that are not given are recognised."""

"""Transforms, surfaces and pixels."""

"""Skeletons from images: networks that find people, and their joints in space by the depth."""

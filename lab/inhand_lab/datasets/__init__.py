"""Folders of labelled recordings: read, written, and seen as a tracker sees them."""

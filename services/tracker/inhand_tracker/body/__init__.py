"""The skeleton: its basis, parts, height, and its last moments."""

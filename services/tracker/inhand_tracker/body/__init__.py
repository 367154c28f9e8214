"""The body: reading its joints, its bases and anchors, its height, and its last moments."""

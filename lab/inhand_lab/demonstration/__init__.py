"""The demonstration rig, and what its recording shows."""

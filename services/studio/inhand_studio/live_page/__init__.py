"""Live: what a camera sees, with the people and objects in it, and how the rig does."""

"""A simulated person with an object before a camera."""

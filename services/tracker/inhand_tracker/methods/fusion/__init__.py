"""The default method: the body's prior, what is carried over, and the image."""

"""What an image says of poses of one object."""

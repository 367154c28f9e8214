"""What several cameras see of the same people, brought together in one frame of reference."""

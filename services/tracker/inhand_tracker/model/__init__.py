"""What is learned of one object in one interaction, and its file."""

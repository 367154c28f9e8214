"""The command line, the roof of the house: one verb a file."""

"""The interactions, one a file; each performs as a right-handed person in the person's world."""

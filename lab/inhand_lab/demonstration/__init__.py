"""The demonstration: a rig of simulated people, and a review of its recording."""

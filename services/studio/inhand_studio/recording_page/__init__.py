"""The page on which training recordings of the rig are made."""

"""The page that trains a model of recordings, and puts it into the running rig."""

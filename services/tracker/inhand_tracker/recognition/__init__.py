"""Which object is in use, when nobody says."""

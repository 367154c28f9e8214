"""How near the simulated sensors are to real ones."""

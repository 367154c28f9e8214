"""Simulated bodies: joints, proportions, posture and surface."""

"""Benchmarks: costs in time and memory, and the worth of each part."""

"""Recordings made of what other programs recorded, one format a module (docs/exports.md)."""

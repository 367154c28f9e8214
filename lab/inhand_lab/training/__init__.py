"""Trains models and recognisers from datasets."""

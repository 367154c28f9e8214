"""Models and recognisers from datasets."""

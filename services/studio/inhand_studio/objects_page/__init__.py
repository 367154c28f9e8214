"""The page on which objects of the dataset are made, and looked at beside a hand."""

"""Where the real recordings lie that some tests read, beside the checkout."""

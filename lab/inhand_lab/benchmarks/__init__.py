"""What things cost, and what each part is worth."""

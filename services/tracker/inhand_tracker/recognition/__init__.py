"""Recognition of the object that a person uses, where nobody says which it is."""

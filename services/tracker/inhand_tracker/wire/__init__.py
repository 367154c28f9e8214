"""Messages to arrays and back; the rest of the tracker knows no message but a person's."""

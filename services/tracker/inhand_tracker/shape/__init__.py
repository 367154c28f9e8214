"""An object's mesh, and what is seen of it from all directions."""

"""What sensors make of the world: pictures, depth and skeletons with their errors."""

"""Labels of an object in a recording: a person's keyframes, and the poses between them."""

"""People in view: each is followed, identified, and watched with the objects they use."""

"""How objects are tracked: the protocol, the registry, and a package for each method."""

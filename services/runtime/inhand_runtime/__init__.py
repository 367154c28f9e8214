"""What every daemon shares: settings, session, lifecycle, health, logs, pixels and recordings."""

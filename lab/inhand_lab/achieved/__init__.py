"""What was truly achieved in a simulated performance, by its stages and its true geometry."""

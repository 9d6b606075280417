"""From a model and its rows to normal equations, and from these to a fitted model."""

"""Scripts that keep the project's own pages true to its code."""

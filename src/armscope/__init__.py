"""armscope: see where a robot arm misses its target, and why."""

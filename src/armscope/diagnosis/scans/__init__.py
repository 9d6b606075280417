"""Numbers found by scanning: periods per turn, times of jumps."""

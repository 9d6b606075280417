"""Exciting motions: trajectories from which masses, friction and their rivals can be told."""

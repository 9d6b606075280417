"""Sealed worlds of arms in motion: torques by MuJoCo, what drives record of them, and what was concealed."""

"""The fitted model of a moving arm: its file, its torques, its exports."""

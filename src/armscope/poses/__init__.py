"""Identification poses: which to measure so that a chosen set of effects shows best."""

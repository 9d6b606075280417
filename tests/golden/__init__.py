"""Verdicts that must stay as they are while the house is rebuilt."""

"""Rows, their weights, and rounds of selection until the names rest."""

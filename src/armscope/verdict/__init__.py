"""What a diagnosis says: plain data, its words and its files."""

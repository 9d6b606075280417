"""The proof: worlds are made and sealed, diagnosed by what is visible, and only then unsealed and scored."""

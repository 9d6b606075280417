"""What a person looks at: figures, tables and self-contained HTML pages."""

"""What every room uses: errors, files, configuration, variants, digests of sources."""

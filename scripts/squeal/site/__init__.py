"""Pages of the repository as a site."""

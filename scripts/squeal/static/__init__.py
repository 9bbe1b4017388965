"""The sliding state: pairs, pictures, runs."""

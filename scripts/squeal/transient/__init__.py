"""Transients: tables, spectra, pictures, films and studies."""

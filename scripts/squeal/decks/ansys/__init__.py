"""Decks of Ansys."""

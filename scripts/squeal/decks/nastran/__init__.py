"""Decks of Nastran."""

"""Frequency responses, measured in time or computed."""

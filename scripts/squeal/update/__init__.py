"""What scripts/update does: solve has Gauss and Newton's method with a prior, and what cannot be identified; model runs squeal and pairs
its modes with the measured ones; onset has the spread of onsets, draws that of drawn brakes; written has the tables and scenes that it
writes."""

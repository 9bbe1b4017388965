"""Programs that are run: squeal, launchers; runs that are kept or timed."""

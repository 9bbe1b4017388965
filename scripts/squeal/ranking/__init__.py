"""Which of several unstable modes wins."""

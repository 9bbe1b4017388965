"""What scripts/paper does. plan: which runs each table and figure of the seed paper needs; work: makes them, several
at a time, with the time left; claims: what the paper says beside what comes out here; shapes: pictures of the disc's
face; beside: that part of the page."""

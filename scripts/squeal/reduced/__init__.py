"""Parts of study/reduced."""

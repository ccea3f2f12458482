"""The paper's experiments: what is run for each table, and what becomes of the runs' numbers."""

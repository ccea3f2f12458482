"""The paper's experiments, the atlas of networks, and their tables."""

"""Records of runs, and the numbers, figures and reports made of them."""

"""The velocity controller: one control step, and the policies for steps without a solution."""

"""Plants: robots that move under the controller's velocity commands."""

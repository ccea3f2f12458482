"""Plants: what moves under the controller's velocity commands."""

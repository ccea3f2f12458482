"""Faces of the step at the desk: controllers and shields, their commands, words and warnings."""

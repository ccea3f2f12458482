"""Hostile requests for filters of commands, and judges; numpy alone."""

"""Drivers of arms behind a shield, each a module that is imported where it is used."""

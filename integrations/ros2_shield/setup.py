"""Package for colcon (ament_python) and pip; setup.cfg describes it."""

from setuptools import setup

setup()

"""Package for colcon (ament_python) and pip."""

from setuptools import setup

setup(
    name="ros2_shield",
    version="0.1.0",
    packages=["ros2_shield"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/ros2_shield"]),
        ("share/ros2_shield", ["package.xml"]),
    ],
    python_requires=">=3.10",
    entry_points={"console_scripts": ["shield_node = ros2_shield.node:main"]},
)

"""Drivers of arms behind a shield: `armstep_drivers.ur.UR`, `armstep_drivers.dynamixel.Dynamixel`.

What a driver needs of its arm's maker is imported where it connects.
"""

from armstep_drivers import dynamixel, ur

__all__ = ["dynamixel", "ur"]

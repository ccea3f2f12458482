"""The step of an arm, in kernels: all of it goes to a robot, in armstep's C, and nothing else does.

Costs, tasks and limits stand in `iiwa_dnn.schemes`, networks in `iiwa_dnn.networks`.
"""

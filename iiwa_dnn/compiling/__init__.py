"""Kernels: a subset of Python, translated to C ahead of time, and their library.

`translator` and what it imports read source text alone, so that a build needs none of the package's
own requirements. `library` hands the compiled kernels out. CONTRIBUTING.md describes the subset.
"""

# SPDX-License-Identifier: Apache-2.0
"""A small scene with level sand, for tests that run whole sessions."""

SCENE = """name = "small"
[field]
columns = 64
rows = 48
width = 2.0
[terrain]
kind = "flat"
height = 0.2
[material]
talus_deg = 34
[tool]
radius = 0.1
"""

# SPDX-License-Identifier: Apache-2.0
"""Terrain that a user names in place of a scene: a raster, a picture or points (docs/terrain.md)."""

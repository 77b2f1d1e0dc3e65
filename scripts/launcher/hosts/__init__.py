# SPDX-License-Identifier: Apache-2.0
"""Examines the machines of a wall before a session starts."""

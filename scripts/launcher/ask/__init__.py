# SPDX-License-Identifier: Apache-2.0
"""Asks a session: commands of an operator, its results, and the report on them."""

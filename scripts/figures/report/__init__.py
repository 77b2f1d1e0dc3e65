# SPDX-License-Identifier: Apache-2.0
"""Measures the parts of docs/report, and writes it."""

# SPDX-License-Identifier: Apache-2.0
"""The sessions of `sandwall try`, which are kept and continued (docs/pointer.md)."""

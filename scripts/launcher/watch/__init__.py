# SPDX-License-Identifier: Apache-2.0
"""Watches a session: names what failed, starts it again, and takes spare hosts."""

# SPDX-License-Identifier: Apache-2.0
"""Starts the processes of a session on their hosts, and keeps their output."""

# SPDX-License-Identifier: Apache-2.0
"""Holds what the other rooms use: options, console, events, and the folders of sources and sessions."""

# SPDX-License-Identifier: Apache-2.0
"""Serves the web page."""

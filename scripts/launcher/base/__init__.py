# SPDX-License-Identifier: Apache-2.0
"""What every room uses: options, the console, events, files of others, and the folders of sources and sessions."""

# SPDX-License-Identifier: Apache-2.0
"""The first bytes of journals, as journal/file_origin.cpp writes them."""


def of(form, algorithm, release):
    return b"SWJL" + b"".join(number.to_bytes(4, "little") for number in (form, algorithm, len(release))) + release


OURS = of(10, 16, b"0.2.0")  # of the made-up programs of the tests

# SPDX-License-Identifier: Apache-2.0
# Toolchain of the presets for clang: the version that Debian 12 has, else the newest one that is installed.
if(NOT CMAKE_CXX_COMPILER)
    find_program(SANDWALL_CLANG NAMES clang++-14 clang++-19 clang++-18 clang++-17 clang++-16 clang++-15 clang++)
    if(NOT SANDWALL_CLANG)
        message(FATAL_ERROR "no clang++ found; run scripts/install_dependencies.sh --with-tests")
    endif()
    set(CMAKE_CXX_COMPILER ${SANDWALL_CLANG})
endif()

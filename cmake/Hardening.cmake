# SPDX-License-Identifier: Apache-2.0
# What makes a fault that somebody finds harder to use, in every program and module. None of it changes a value that is
# computed; what it costs the sand is in docs/security.md.
include(CheckCXXCompilerFlag)
foreach(flag -fstack-protector-strong -fstack-clash-protection -fcf-protection)
    string(MAKE_C_IDENTIFIER "SANDWALL_HAS${flag}" has)
    check_cxx_compiler_flag(${flag} ${has})
    if(${has})
        add_compile_options(${flag})
    endif()
endforeach()
# It needs an optimiser, and sanitizers look at the same calls by themselves.
add_compile_definitions($<$<CONFIG:Release>:_FORTIFY_SOURCE=2>)
# Position-independent objects are Debian's default for g++ and clang; the programs must not fall back unnoticed.
add_link_options($<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-pie>
    LINKER:-z,relro LINKER:-z,now LINKER:-z,noexecstack)

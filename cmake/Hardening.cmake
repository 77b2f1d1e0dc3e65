# SPDX-License-Identifier: Apache-2.0
# Options that make faults harder to exploit, in every program and module. They change no computed value.
# docs/security.md lists their cost for the sand.
include(CheckCXXCompilerFlag)
foreach(flag -fstack-protector-strong -fstack-clash-protection -fcf-protection)
    string(MAKE_C_IDENTIFIER "SANDWALL_HAS${flag}" has)
    check_cxx_compiler_flag(${flag} ${has})
    if(${has})
        add_compile_options(${flag})
    endif()
endforeach()
# Only in Release builds, because _FORTIFY_SOURCE needs optimisation. Sanitizers check the same calls themselves.
add_compile_definitions($<$<CONFIG:Release>:_FORTIFY_SOURCE=2>)
# Debian's g++ and clang make position-independent objects by default. If they do not, these options make the link fail.
add_link_options($<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:-pie>
    LINKER:-z,relro LINKER:-z,now LINKER:-z,noexecstack)

# SPDX-License-Identifier: Apache-2.0
# Writes OUTPUT, a file for ctest with one test per suite of PROGRAM. Hundreds of tests take a millisecond each, and a
# process for each test would cost more time. `;` in PROPERTIES separates names and values. EMULATOR is the program that
# runs a PROGRAM of another architecture, or empty.
if(EMULATOR)
    set(emulator "[=[${EMULATOR}]=] ")
endif()
execute_process(COMMAND ${EMULATOR} ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "(^|\n)[A-Za-z_][A-Za-z0-9_/]*\\." suites "${listed}")
set(text "")
foreach(suite IN LISTS suites)
    string(REGEX REPLACE "[\n.]" "" suite "${suite}")
    string(APPEND text "add_test([=[${PREFIX}${suite}]=] ${emulator}[=[${PROGRAM}]=] [=[--gtest_filter=${suite}.*]=])\n")
    string(APPEND text "set_tests_properties([=[${PREFIX}${suite}]=] PROPERTIES ${PROPERTIES} LABELS \"${LABELS}\" ENVIRONMENT \"${ENVIRONMENT}\")\n")
endforeach()
file(WRITE "${OUTPUT}" "${text}")

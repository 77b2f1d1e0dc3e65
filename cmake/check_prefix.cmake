# SPDX-License-Identifier: Apache-2.0
# The first step of `cmake --install`: refuses a prefix that cannot be written, before anything is installed.
set(prefix "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}")
execute_process(COMMAND mkdir -p "${prefix}" ERROR_QUIET RESULT_VARIABLE refused)
if(NOT refused)
    execute_process(COMMAND test -w "${prefix}" RESULT_VARIABLE refused)
endif()
if(refused)
    message(FATAL_ERROR "${prefix}: cannot be written; choose a folder of yours with --prefix, or install as root")
endif()

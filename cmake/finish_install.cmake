# SPDX-License-Identifier: Apache-2.0
# The last step of `cmake --install`: the link on the PATH, the build id for the launcher, and the man pages. The man pages
# come from --help, so the programs must be installed first. Without help2man there are no man pages.
set(prefix "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}")
set(private "${prefix}/lib/sandwall")

file(MAKE_DIRECTORY "${prefix}/bin")
file(CREATE_LINK ../lib/sandwall/python/sandwall "${prefix}/bin/sandwall" SYMBOLIC)

execute_process(COMMAND "${private}/sandwall-master" --version --json OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
string(JSON build GET "${said}" build)
file(WRITE "${private}/python/build.json" "{\"build\": \"${build}\"}\n")

find_program(HELP2MAN help2man)
if(NOT HELP2MAN)
    message(STATUS "No man pages, because help2man is not installed (apt-get install help2man)")
    return()
endif()
set(pages "${prefix}/share/man/man1")
file(MAKE_DIRECTORY "${pages}")

# Writes the page NAME.1 from the help of a program, or of a command of it.
function(sandwall_man_page name title program)
    # Without bytecode, because the launcher would leave it in the installed tree. No line is wrapped, because help2man
    # takes only the first line of a synopsis.
    set(ENV{PYTHONDONTWRITEBYTECODE} 1)
    set(ENV{COLUMNS} 10000)
    execute_process(
        COMMAND ${HELP2MAN} --no-info --no-discard-stderr --section=1 --locale=C.UTF-8 --source=Sandwall
                "--manual=User Commands" "--version-string=${sandwall_version}" "--name=${title}"
                "--help-option=${ARGN} --help" "--output=${pages}/${name}.1" "${program}"
        ERROR_VARIABLE complaints RESULT_VARIABLE status)
    if(NOT status EQUAL 0 OR complaints)
        message(FATAL_ERROR "${name}.1: help2man failed: ${complaints}")
    endif()
    # help2man names the page of a command after the program.
    file(READ "${pages}/${name}.1" page)
    string(TOUPPER "${name}" capitals)
    string(REGEX REPLACE "(\n\\.TH )[A-Z-]+" "\\1${capitals}" page "${page}")
    string(REGEX REPLACE "(\n\\.SH NAME\n)[^ ]+" "\\1${name}" page "${page}")
    file(WRITE "${pages}/${name}.1" "${page}")
endfunction()

set(launcher "${private}/python/sandwall")
sandwall_man_page(sandwall "run sand on a display wall" "${launcher}")
sandwall_man_page(sandwall-run "run a session" "${launcher}" run)
sandwall_man_page(sandwall-try "dig in sand on this desktop" "${launcher}" try)
sandwall_man_page(sandwall-ctl "command a running session" "${launcher}" ctl)
sandwall_man_page(sandwall-film "make a film of a session" "${launcher}" film)
sandwall_man_page(sandwall-doctor "check the machines of a wall" "${launcher}" doctor)
sandwall_man_page(sandwall-web "show a session in a web page that computes it again" "${launcher}" web)
sandwall_man_page(sandwall-master "lead the render ranks of a wall" "${private}/sandwall-master")
sandwall_man_page(sandwall-render-node "draw one tile of a wall" "${private}/sandwall-render-node")
sandwall_man_page(sandwall-haptic-server "feel the sand for a hand" "${private}/sandwall-haptic-server")
sandwall_man_page(sandwall-replay "replay, verify or export a journal" "${private}/sandwall-replay")
sandwall_man_page(sandwall-relax "relax a terrain without a wall" "${private}/sandwall-relax")
sandwall_man_page(sandwall-check "check a wall file" "${private}/sandwall-check")
sandwall_man_page(sandwall-compare "compare two pictures" "${private}/sandwall-compare")
sandwall_man_page(sandwall-track "print or send poses of a head" "${private}/sandwall-track")
sandwall_man_page(sandwall-watch "watch a haptic server" "${private}/sandwall-watch")

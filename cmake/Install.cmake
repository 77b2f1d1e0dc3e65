# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` installs (docs/install.md). Programs and modules are in one folder, so a program finds its modules
# beside itself, and the tree works under any prefix. Test helpers, benchmarks and examples are not installed.
# scripts/launcher/base/layout.py has the same folders.
set(programs sandwall-master sandwall-render-node sandwall-haptic-server sandwall-replay sandwall-relax sandwall-check
    sandwall-compare sandwall-track sandwall-watch)
set(modules sandwall-import sandwall-security sandwall-gl-egl sandwall-gl-glfw)
if(OSMESA_FOUND)
    list(APPEND modules sandwall-gl-osmesa)
endif()
set(private lib/sandwall)
set(shared share/sandwall)
set(docs share/doc/sandwall)

# The options of each program, beside it. The launcher offers them, so it runs no program for its help and completion
# (scripts/launcher/base/program_options.py).
set(option_lists)
foreach(program ${programs})
    set(list ${CMAKE_RUNTIME_OUTPUT_DIRECTORY}/${program}.json)
    add_custom_command(OUTPUT ${list}
        COMMAND ${program} --options-json > ${list}.part
        COMMAND ${CMAKE_COMMAND} -E rename ${list}.part ${list}
        DEPENDS ${program} VERBATIM)
    list(APPEND option_lists ${list})
endforeach()
add_custom_target(option_lists ALL DEPENDS ${option_lists})

# All that a session needs. scripts/demo.sh builds only this target.
add_custom_target(sandwall)
add_dependencies(sandwall ${programs} ${modules} option_lists)

install(SCRIPT cmake/check_prefix.cmake)
install(TARGETS ${programs} ${modules} RUNTIME DESTINATION ${private} LIBRARY DESTINATION ${private})
install(FILES ${option_lists} DESTINATION ${private})
install(PROGRAMS scripts/launcher/sandwall DESTINATION ${private}/python)
install(DIRECTORY scripts/launcher/ DESTINATION ${private}/python FILES_MATCHING PATTERN "*.py"
    PATTERN samples EXCLUDE PATTERN __pycache__ EXCLUDE)
install(FILES docs/schemas/summary.schema.json DESTINATION ${private}/python)
# The web page, if scripts/web.sh has built it.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/build/web/page/ DESTINATION ${shared}/web OPTIONAL)
install(DIRECTORY scenes/ DESTINATION ${shared}/scenes)
install(DIRECTORY walls/configs/ DESTINATION ${shared}/walls)
install(DIRECTORY haptic_bridge/devices/ DESTINATION ${shared}/strokes FILES_MATCHING PATTERN "*.strokes")
install(DIRECTORY scripts/launcher/samples/ DESTINATION ${shared}/samples USE_SOURCE_PERMISSIONS)
install(PROGRAMS haptic_bridge/examples/position_sender.py DESTINATION ${shared}/examples)
install(FILES README.md CHANGELOG.md CONTRIBUTING.md SECURITY.md CITATION.cff LICENSE DESTINATION ${docs})
install(DIRECTORY docs DESTINATION ${docs})
install(FILES scripts/launcher/completion.bash DESTINATION share/bash-completion/completions RENAME sandwall)
install(CODE "set(sandwall_version ${PROJECT_VERSION})")
install(SCRIPT cmake/finish_install.cmake)

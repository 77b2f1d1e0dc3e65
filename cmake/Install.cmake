# SPDX-License-Identifier: Apache-2.0
# What `cmake --install` installs (docs/install.md). Programs and modules are in one folder, so a program finds its modules
# beside itself, and the tree works under any prefix. Test helpers, benchmarks and examples are not installed.
# scripts/launcher/layout.py has the same folders.
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
# (scripts/launcher/program_options.py).
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
install(FILES
    scripts/launcher/bounded_log.py scripts/launcher/checked_json.py scripts/launcher/command_line.py scripts/launcher/completion.py
    scripts/launcher/console.py scripts/launcher/desk.py scripts/launcher/doctor.py
    scripts/launcher/environment.py scripts/launcher/events.py scripts/launcher/examined_host.py
    scripts/launcher/failed_processes.py scripts/launcher/film.py scripts/launcher/first_frame.py
    scripts/launcher/job_guard.py scripts/launcher/job_log.py scripts/launcher/job_outlet.py scripts/launcher/job_stream.py scripts/launcher/json_schema.py
    scripts/launcher/layout.py scripts/launcher/machine_needs.py scripts/launcher/marked_answer.py
    scripts/launcher/mpirun_end.py scripts/launcher/patience.py scripts/launcher/open_mpi.py scripts/launcher/pointer.py
    scripts/launcher/process_failure.py scripts/launcher/processes.py scripts/launcher/program_options.py
    scripts/launcher/programs.py scripts/launcher/rank_hosts.py scripts/launcher/reachable.py
    scripts/launcher/screens.py scripts/launcher/server_watch.py scripts/launcher/session_control.py
    scripts/launcher/session_folder.py scripts/launcher/session_lines.py scripts/launcher/session_report.py
    scripts/launcher/session_results.py scripts/launcher/session_rules.py scripts/launcher/spare_hosts.py
    scripts/launcher/supervisor.py scripts/launcher/text_file.py scripts/launcher/this_machine.py
    scripts/launcher/web_files.py scripts/launcher/web_page.py
    docs/schemas/summary.schema.json
    DESTINATION ${private}/python)
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

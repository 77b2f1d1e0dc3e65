# SPDX-License-Identifier: Apache-2.0
# Hashes the flags and files in MANIFEST (cmake/BuildId.cmake), with paths relative to ROOT. Writes build_id.cpp and
# module_id.cpp into the folder OUTPUT. Prints the id if OUTPUT is not set.
file(STRINGS "${MANIFEST}" lines)
set(all "")
foreach(line IN LISTS lines)
    string(APPEND all "${line}\n")
    if(line MATCHES "^file (.*)$")
        file(SHA256 "${ROOT}/${CMAKE_MATCH_1}" hash)
        string(APPEND all "${hash}\n")
    endif()
endforeach()
string(SHA256 id "${all}")
string(SUBSTRING "${id}" 0 16 id)
if(NOT DEFINED OUTPUT)
    message("${id}")
    return()
endif()
file(WRITE "${OUTPUT}/build_id.cpp"
    "#include \"host/build_id.hpp\"\nnamespace host {\nconst char* buildId() { return \"${id}\"; }\n}  // namespace host\n")
file(WRITE "${OUTPUT}/module_id.cpp"
    "extern \"C\" __attribute__((visibility(\"default\"))) const char* sandwallBuildId() { return \"${id}\"; }\n")

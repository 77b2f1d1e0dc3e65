# SPDX-License-Identifier: Apache-2.0
# Writes OUTPUT: one hash over the sources in LIST_FILE and the compiler that builds them.
file(STRINGS "${LIST_FILE}" sources)
set(all "${COMPILER}")
foreach(source IN LISTS sources)
    file(SHA256 "${source}" hash)
    string(APPEND all "${hash}")
endforeach()
string(SHA256 id "${all}")
string(SUBSTRING "${id}" 0 16 id)
file(WRITE "${OUTPUT}" "#include \"lockstep/build_id.hpp\"\nnamespace lockstep {\nconst char* buildId() { return \"${id}\"; }\n}\n")
